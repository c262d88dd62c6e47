// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

namespace chromeball {

void addSceneOptions(CLI::App& command, RenderOptions& o) {
  command.parse_complete_callback([&command, &o] {
    for (const CLI::Option* option : command.get_options())
      if (option->count() > 0)
        o.given.push_back({option->get_single_name(), CLI::detail::join(option->results(), ",")});
  });
  command.add_option("scene", o.scene, "Scene file (.toml) or model (.gltf, .glb)")->required();
  command.add_option("--probe", o.probe, "Light probe: .hdr, .exr or .pfm (else the model's own)");
  command.add_option("--probe-mapping", o.mapping,
                     "auto, lat-long, angular, mirror-ball, cube-cross or cube-strip");
  command.add_option("--probe-rotation", o.rotation,
                     "Degrees the environment turns, counter-clockwise from above");
  command.add_option("--probe-scale", o.scale, "Factor on the probe's radiance");
  command.add_option("--size", o.size, "WxH in pixels");
  command.add_option("--mis", o.mis, "off, balance or power");
  command.add_option("--max-depth", o.maxDepth, "Bounces: 0 emission, 1 direct light, ... (8)");
  command.add_option("--max-transmission-depth", o.maxTransmissionDepth,
                     "Bounces in and on bodies of glass, which --max-depth does not count (64)");
  command.add_option("--single-sided", o.singleSided,
                     "What single-sided surfaces hide from behind: themselves from the camera and "
                     "mirrors (camera), from all light too (light), or nothing (off)");
  command.add_option("--lights", o.lights,
                     "The models' own lights: off, or a factor on them (1); not on lamps that are "
                     "surfaces");
  command.add_option("--light-units", o.lightUnits,
                     "Of the models' lights: photometric (683 lm/W, as Blender's), or radiometric "
                     "(1 cd is 1 W/sr)");
  command.add_option("--camera", o.camera, "Name of one of the model's cameras, or of its node");
  command.add_option("--animation", o.animation, "Show the models in the pose of this animation");
  command.add_option("--animation-time", o.animationTime, "at this time, in seconds (0)");
  command.add_option("--variant", o.variant, "Show the models in this variant of their materials");
  command.add_option("--seed", o.seed, "Another seed, another independent picture (0)")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? "`" + text + "` is not a whole number, 0 or more" : "";
      });
  command.add_option("--threads", o.threads, "Number of threads (all)");
  command.add_option("--tonemap", o.tonemap, "For .png: none, reinhard, aces, neutral or filmic");
  command.add_option("--exposure", o.exposure, "For .png: stops");
  command.add_option("--memory", o.memory,
                     "Refuse pictures that take more than this, in GB (0.8 times the machine's)");
  command.add_flag("--allow-external", o.allowExternal,
                   "Let models name files outside their own folders");
  command.add_flag("--progress", o.progress, "Show progress even where it is no terminal");
  command.add_flag("--quiet", o.quiet, "Show neither progress nor notes; warnings stay");
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// chromeball probe split PROBE --suns suns.json --rest rest.exr
// chromeball probe add-sun REST.exr OUT.exr --lights suns.json
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/file.h"
#include "commands.h"
#include "image/io/output_file.h"
#include "image_files.h"
#include "lighting/export/light_file.h"
#include "messages.h"
#include "probe/sun_extraction.h"
#include "probe/synth.h"
#include "probe_options.h"

namespace chromeball {
namespace {

struct SplitArguments {
  LightsProbe probe;
  std::string suns, rest;
  std::optional<double> angle;
};

void splitProbe(const SplitArguments& arguments) {
  if (arguments.angle &&
      !(*arguments.angle >= kLeastListedAngle && *arguments.angle <= kMaxListedAngle))
    throwInput("--angle: should be {} to {} degrees", kLeastListedAngle, kMaxListedAngle);
  arguments.probe.checkMask();
  if (lightFormat(arguments.suns, "", "") != LightFormat::Json)
    throwInput("--suns: {} should end in .json, which [[light]] and `probe add-sun` read",
               arguments.suns);
  checkReplaceable(arguments.suns);
  checkWritable(arguments.rest);
  checkDistinct({arguments.suns, arguments.rest}, {arguments.probe.file});
  const SunExtraction extraction = extractSuns(arguments.probe.load());
  LightRig rig{.probe = arguments.probe.file, .method = "suns", .ambient = {}, .lights = {}};
  for (const Sun& sun : extraction.suns)
    rig.lights.push_back(
        {vec3(sun.direction), Rgb(sun.irradiance), float(arguments.angle.value_or(sun.angle))});
  writeProbe(arguments.rest, extraction.remainder);
  writeLights(arguments.suns, rig);
  say("suns        {}\n", extraction.suns.size());
  for (const DirectionalLight& light : rig.lights)
    say("sun         direction {:.4f} {:.4f} {:.4f}, irradiance {:.4g} {:.4g} {:.4g}, diameter "
        "{:.4g} degrees\n",
        light.direction.x, light.direction.y, light.direction.z, light.irradiance.x,
        light.irradiance.y, light.irradiance.z, light.angle);
}

struct AddArguments {
  LightsProbe probe;
  std::string out, lights;
};

// Lights without an angle become as small as a map can show.
void addSuns(const AddArguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.probe.file, arguments.lights});
  const LightList list = readLights(arguments.lights);
  Image map = arguments.probe.load();
  const Rgb ambient = list.ambient.value_or(Rgb(0));
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) map.setRgb(x, y, map.rgb(x, y) + ambient);
  for (const DirectionalLight& light : list.lights)
    addSunDisc(map, glm::normalize(dvec3(light.direction)),
               std::max<double>(light.angle, kLeastListedAngle), dvec3(light.irradiance));
  for (const float texel : map.texels)
    if (!std::isfinite(texel))
      throwInput("{}: with {} a texel exceeds the largest float, 3.4e38", arguments.lights,
                 arguments.probe.file);
  writeProbe(arguments.out, map);
}

}  // namespace

void addProbeSplitCommand(Command probe) {
  auto [command, a] = probe.addCommand<SplitArguments>(
      "split",
      "Divide a probe into its suns, as a list of lights, and the rest, as a lat-long map.",
      splitProbe);
  command.addRequired("PROBE", a.probe.file, "the probe's image");
  command.addRequired("--suns", a.suns, "the .json to write; [[light]] `file` reads it");
  command.addRequired("--rest", a.rest, "the image to write: .exr, .hdr, .pfm or .png");
  command.addOption(
      "--angle", a.angle,
      "diameter of the suns in degrees, in place of the measured one; the Sun's is 0.5323");
  command.addOption("--probe-mask", a.probe.mask, kMaskHelp);
  command.addOption("--probe-mapping", a.probe.mapping, "the mapping of PROBE; auto detects it");
}

void addProbeAddSunCommand(Command probe) {
  auto [command, a] = probe.addCommand<AddArguments>(
      "add-sun", "Draw a list of lights into a probe: discs of constant radiance.", addSuns);
  command.addRequired("IN", a.probe.file, "the probe's image");
  command.addRequired("OUT", a.out, "the lat-long map to write: .exr, .hdr, .pfm or .png");
  command.addRequired("--lights", a.lights,
                      "the .json of `probe split` or `lights`; its ambient light is added too");
  command.addOption("--probe-mapping", a.probe.mapping, "the mapping of IN; auto detects it");
}

}  // namespace chromeball

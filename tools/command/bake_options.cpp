// SPDX-License-Identifier: Apache-2.0
#include "bake_options.h"

#include <algorithm>
#include <cmath>

#include "bake/atlas.h"
#include "base/error.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"

namespace chromeball {
namespace {

constexpr int kMinPage = 16, kMaxPadding = 256;

template <size_t N>
size_t indexOf(const std::string& name, const char* const (&names)[N], const char* option) {
  const auto found = std::ranges::find(names, name);
  if (found == std::end(names))
    throwInput("{}: `{}` is not one of {}", option, name, fmt::join(names, ", "));
  return size_t(found - std::begin(names));
}

void checkRange(const char* option, const std::optional<int64_t>& number, int least, int most) {
  if (number && (*number < least || *number > most))
    throwInput("{}: should be a whole number from {} to {} (texels)", option, least, most);
}

}  // namespace

BakedLight BakeOptions::light() const {
  return BakedLight(indexOf(what, kBakedLightNames, "--what"));
}

void checkBakeOptions(const BakeOptions& a) {
  constexpr const char* kTargets[] = {"lightmap", "vertices"};
  const BakedLight what = a.light();
  indexOf(a.to, kTargets, "--to");
  checkRange("--size", a.size, kMinPage, kMaxPage);
  checkRange("--padding", a.padding, 0, kMaxPadding);
  if (a.size && a.texel) throwInput("--texel: excludes --size; give one");
  if (a.texel && !(*a.texel > 0 && std::isfinite(*a.texel)))
    throwInput("--texel: should be a length above 0 (metres)");
  if (a.scale && !isPositiveFloat(*a.scale)) throwInput("--scale: should be {}", kPositiveFloats);
  if (a.scale && (what == BakedLight::AmbientOcclusion || a.keepsMaterials))
    throwInput("--scale: is of colours that the file shows without light; leave it out");
  if (a.toVertices())
    for (const auto& [given, option] :
         {std::pair(a.size.has_value(), "--size"), std::pair(a.padding.has_value(), "--padding"),
          std::pair(a.texel.has_value(), "--texel"), std::pair(a.denoises, "--denoise"),
          std::pair(a.keepsNoise, "--no-denoise")})
      if (given) throwInput("{}: is for lightmaps; leave it out with --to vertices", option);
  if (a.settings.has("render.ao_distance") && a.what != "ambient-occlusion")
    throwInput("--ao-distance: is for --what ambient-occlusion");
  if (a.settings.get<uint64_t>("render.samples") < 2) throwInput("--samples: should be 2 or more");
  checkOutputFile(a.output, {".glb", ".gltf"});
  if (!a.toVertices()) checkWritable(a.lightmapPath());
}

void addBakeOptions(Command command, BakeOptions& options) {
  addSceneOptions(command, options, SceneCommand::Bake);
  command.addRequired(
      "-o,--output", options.output,
      "the model to write: .glb or .gltf; a lightmap is also written as .exr beside it");
  command.addWithDefault("--what", options.what,
                         "irradiance, ambient-occlusion, or radiance along the normal");
  command.addWithDefault("--to", options.to, "lightmap (TEXCOORD_1) or vertices (COLOR_0)");
  command.addOption("--size", options.size,
                    "of the lightmap, in texels along an edge, up to 16384; 1024 by default");
  command.addOption("--texel", options.texel,
                    "in place of --size: metres along the edge of a texel");
  command.addOption("--padding", options.padding, "texels around each chart; 4 by default");
  command.addOption("--scale", options.scale,
                    "the light that the file's white stands for; by default a power of two that "
                    "clips only what emits");
  Option denoises =
      command.addFlag("--denoise", options.denoises, "remove noise from lightmaps: the default");
  command.addFlag("--no-denoise", options.keepsNoise, "do not").excludes(denoises);
  command.addFlag("--keep-materials", options.keepsMaterials,
                  "write the model's own materials; engines take the light from the .exr or from "
                  "_IRRADIANCE of the vertices");
}

}  // namespace chromeball

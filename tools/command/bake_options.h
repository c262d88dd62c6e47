// SPDX-License-Identifier: Apache-2.0
// The options of chromeball bake.
#pragma once

#include <filesystem>
#include <optional>

#include "bake/bake.h"
#include "scene_options.h"

namespace chromeball {

struct BakeOptions : SceneOptions {
  std::string what = "irradiance", to = "lightmap", output;
  std::optional<int64_t> size, padding;  // texels
  std::optional<double> texel;           // metres
  std::optional<double> scale;           // the light that white stands for
  bool denoises = false, keepsNoise = false, keepsMaterials = false;

  bool toVertices() const { return to == "vertices"; }
  BakedLight light() const;  // throws InputError for an unknown name
  std::filesystem::path lightmapPath() const {
    return std::filesystem::path(output).replace_extension(".exr");
  }
};

// `options` is filled when the command line is parsed; it must outlive `command`.
void addBakeOptions(Command command, BakeOptions& options);

// Throws InputError for values out of range, for options that exclude each other, and for outputs
// that cannot be written.
void checkBakeOptions(const BakeOptions& options);

}  // namespace chromeball

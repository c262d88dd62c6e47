// SPDX-License-Identifier: Apache-2.0
// chromeball relight STAGE.exr --probe P -o OUT.exr: pictures of a light stage, or of photographs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "math/rotation.h"

namespace chromeball {

// The options as on the command line.
struct RelightOptions {
  std::string stage;               // or:
  std::string images, directions;  // photographs
  std::string irradiance = "1";    // of the photographs
  std::vector<std::string> probes;
  std::string mapping = "auto", scale = "1";
  Rotation rotation;
  std::string domain = "auto", keep = "100%", keepLight = "100%";
  std::string pixel;  // of the reflectance function
  std::string out, tone = "none";
  float exposure = 0;
  std::optional<double> white;  // of a model
  std::string view;             // of a model with glossy transfer
  bool allowsExternal = false, quiet = false;
  std::string preview;           // the port; empty: none
  std::optional<double> memory;  // GB

  bool isOfPhotographs() const { return !images.empty() || !directions.empty(); }
  bool isOfModel() const {
    const std::string extension = lowerExtension(stage);
    return extension == ".glb" || extension == ".gltf";
  }
  const std::string& source() const { return isOfPhotographs() ? images : stage; }
};

// These throw InputError.
void runRelitPicture(const RelightOptions& a);
void runReflectanceFunction(const RelightOptions& a);
void runRelightPreview(const RelightOptions& a);

}  // namespace chromeball

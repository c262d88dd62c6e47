// SPDX-License-Identifier: Apache-2.0
// chromeball relight: the options, and what is made: pictures of a light stage or of photographs, a
// page, and the vertex colours of a model with transfer.
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
  std::optional<double> white;  // of a model: the light that its white stands for
  std::string view;             // "X,Y,Z", metres: the eye, of a model with glossy transfer
  bool allowsExternal = false;
  std::string preview;           // the port; empty: none
  std::optional<double> memory;  // GB

  bool isOfPhotographs() const { return !images.empty() || !directions.empty(); }
  bool isOfModel() const {
    const std::string extension = lowerExtension(stage);
    return extension == ".glb" || extension == ".gltf";
  }
  const std::string& source() const { return isOfPhotographs() ? images : stage; }
};

// These throw InputError, and RunError.
void runRelitPicture(const RelightOptions& a);
void runReflectanceFunction(const RelightOptions& a);
void runRelightPreview(const RelightOptions& a);
void runRelightModel(const RelightOptions& a);

}  // namespace chromeball

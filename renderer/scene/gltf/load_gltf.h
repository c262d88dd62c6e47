// SPDX-License-Identifier: Apache-2.0
// Reads glTF 2.0 (.gltf, .glb) into a Scene.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace chromeball {

// Takes one line of warning ("FILE: what was ignored"), each said once per file.
using Warn = std::function<void(const std::string&)>;

// Whether a model may name files outside its own folder: by an absolute path, by "..", or through a
// link. URIs with a scheme (http:, file:) are refused in any case.
enum class ExternalFiles { Refuse, Allow };

// An animation of the file and the time to show it at.
struct AnimationTime {
  std::string name;      // or its index where it has none; empty: the first
  std::string location;  // where it was asked for, for the error where it does not exist
  double seconds = 0;
};

// A variant of the file's materials (KHR_materials_variants).
struct VariantChoice {
  std::string name;
  std::string location;  // where it was asked for, for the error where it does not exist
};

// What of a file to show, and what it may ask for.
struct GltfChoice {
  std::optional<AnimationTime> animation;  // else the rest pose
  std::optional<VariantChoice> variant;    // else the materials that the primitives name
  ExternalFiles external = ExternalFiles::Refuse;
  LightUnits lightUnits = LightUnits::Photometric;  // of KHR_lights_punctual
  bool environment = true;                          // whether the file's own light probe is wanted
  glm::dvec3 origin{0};  // of the scene in the world: subtracted while numbers are still doubles
};

// Reads the default scene of the file (the first where none is named), with `placement` applied to
// its roots. Throws InputError (file and reason) for whatever is not well-formed, refers outside
// its buffers, or requires an extension that is not supported.
Scene loadGltf(const std::string& path, const Transform& placement, const Warn& warn,
               const GltfChoice& choice = {});

}  // namespace chromeball

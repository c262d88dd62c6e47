// SPDX-License-Identifier: Apache-2.0
// Reads glTF 2.0 (.gltf, .glb) into a Scene, and what a file of this program has besides.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

struct ModelCache;

// Receives one line per warning ("FILE: what was ignored"), the same one only once per file.
using Warn = std::function<void(const std::string&)>;

// Whether a model may refer to files outside its own folder: by an absolute path, by "..", or
// through a link. URIs with a scheme (http:, file:) are always errors.
enum class ExternalFiles { Refuse, Allow };

// An animation of the file and the time at which to show it.
struct AnimationTime {
  std::string name;                    // or its index if it has no name; empty: the first animation
  std::string location = "animation";  // of the setting, for the error if it does not exist
  double seconds = 0;
  bool ifAny = false;  // a file without animations stays in its rest pose
};

// A variant of the file's materials (KHR_materials_variants).
struct VariantChoice {
  std::string name;
  std::string location = "variant";  // of the setting, for the error if it does not exist
};

// Options of loadGltf().
struct GltfChoice {
  std::optional<AnimationTime> animation;  // nullopt: the rest pose
  std::optional<VariantChoice> variant;    // nullopt: the materials of the primitives themselves
  ExternalFiles external = ExternalFiles::Refuse;
  LightUnits lightUnits = LightUnits::Photometric;  // of KHR_lights_punctual
  bool environment = true;                          // whether to read the file's own light probe
  ModelCache* cache = nullptr;                      // of earlier loads; outlives this one
  glm::dvec3 origin{0};  // scene origin in world space, subtracted in double precision
};

// Whether the file begins like a GLB or like a JSON object.
bool beginsAsGltf(const std::string& path);

// Times after the one that `choice` shows, in seconds from it and fewer than `seconds`, at which a
// channel of its animation has another value than then: those of keys, and between the keys of a
// cubic spline the middles. Ascending; empty without an animation. Throws as loadGltf() does.
std::vector<double> animationChanges(const std::string& path, const GltfChoice& choice,
                                     double seconds);

// Reads the default scene of the file (the first if the file names none) and applies `placement` to
// its roots. Throws InputError ("FILE: reason") if the file is invalid, refers to bytes outside its
// buffers, or requires an unsupported extension.
Scene loadGltf(const std::string& path, const Transform& placement, const Warn& warn,
               const GltfChoice& choice = {});

// Data that a glTF file of this program carries besides a scene.

struct CustomData {
  using Arrays = std::map<std::string, std::vector<vec3>>;

  // For each node, the attributes of its mesh's only primitive whose names start with the prefix,
  // each of finite vectors. Nodes whose mesh has several primitives have none.
  std::map<int, Arrays> attributes;
  std::set<int> turned;  // the nodes of these that turn, mirror or stretch their mesh
  Arrays tables;         // the accessors of extras.chromeball.tables
  std::map<std::string, std::string> texts;  // strings of extras.chromeball
  glm::dvec3 origin{0};                      // extras.chromeball.origin
};

// Throws InputError ("FILE: reason") as loadGltf(), and for vectors that are not finite.
CustomData readCustomData(const std::string& path, const std::string& prefix,
                          ExternalFiles external);

}  // namespace chromeball

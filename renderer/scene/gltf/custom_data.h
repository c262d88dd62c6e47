// SPDX-License-Identifier: Apache-2.0
// Data that a glTF file of this program carries besides a scene.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/gltf/load_gltf.h"

namespace chromeball {

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

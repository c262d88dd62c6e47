// SPDX-License-Identifier: Apache-2.0
// Which meshes of a glTF file are equal.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace chromeball {

// Everything that determines an unskinned mesh: primitives with equal recipes have equal meshes.
struct MeshRecipe {
  int mode, indices;
  std::map<std::string, int> attributes;
  std::vector<std::map<std::string, int>> targets;
  std::vector<double> weights;
  std::vector<int> uvSets;             // those that the material reads
  std::vector<uint32_t> tangentSpace;  // UV set and the bits of its transform; empty: no tangents
  bool hasAlpha;                       // kept apart: tracing is faster if no mesh mixes the two

  auto operator<=>(const MeshRecipe&) const = default;
};

}  // namespace chromeball

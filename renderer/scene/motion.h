// SPDX-License-Identifier: Apache-2.0
// How geometry and lamps move while the shutter is open. Time is in [0, 1], from its opening to its
// closing; keys are at equally spaced times, the first at 0 and the last at 1.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "scene/mesh.h"
#include "scene/transform.h"

namespace chromeball {

inline constexpr int kMostMotionSteps = 128;  // between two keys each; Embree's limit

// The two keys around a time, and the fraction of the way from the first to the second.
struct KeySpan {
  size_t from, to;
  float fraction;
};
inline KeySpan keysAround(size_t keys, float time) {
  const float position = std::clamp(time, 0.0f, 1.0f) * float(keys - 1);
  const size_t from = std::min(size_t(position), keys - 2);
  return {from, from + 1, position - float(from)};
}

// Where an instance is. Between two keys its vertices move along straight lines, as Embree moves
// them. All meshes have the same triangles.
struct InstanceMotion {
  struct Key {
    MeshList::Shared mesh;
    std::optional<Transform> toWorld;

    vec3 point(uint32_t vertex) const {
      const vec3& p = mesh->positions[vertex];
      return toWorld ? toWorld->point(p) : p;
    }
    bool operator==(const Key&) const = default;
  };
  std::vector<Key> keys;  // at least 2

  KeySpan at(float time) const { return keysAround(keys.size(), time); }
  vec3 point(uint32_t vertex, const KeySpan& span) const {
    return glm::mix(keys[span.from].point(vertex), keys[span.to].point(vertex), span.fraction);
  }
  // Whether the mesh keeps its shape, so that only its transform moves.
  bool isRigid() const {
    return std::ranges::all_of(keys, [&](const Key& k) { return k.mesh == keys.front().mesh; });
  }
};

}  // namespace chromeball

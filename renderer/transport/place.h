// SPDX-License-Identifier: Apache-2.0
// Surfaces that coincide, as layers with no distance between them.
#pragma once

#include <array>

#include "scene/surface.h"
#include "trace/ray.h"

namespace chromeball {

// The surfaces at the end of a path's ray, if there are several, in the order in which the path
// crosses them: bodies that it enters, then sheets, then bodies that it leaves, so that touching
// bodies refract as one boundary. Bodies are entered in the order of the scene, and left in the
// reverse of the order in which they were entered: a path that the last body reflects is back in
// the medium that it came from. Sheets have the reverse order from the other side. No path crosses
// an opaque surface: it is alone. Surfaces beyond kMost are ignored.
struct Place {
  static constexpr int kMost = 8;

  int count = 0;        // 0: the path is not at such a place
  int at = 0;           // the path's surface
  vec3 axis{0};         // unit; the order ascends along it
  float rayOffset = 0;  // the largest of the surfaces
  std::array<Hit, kMost> hits;

  explicit operator bool() const { return count > 0; }
  const Hit& current() const { return hits[size_t(at)]; }

  // Moves to the next surface for a path that continues in this direction; to none behind the last.
  void leave(const vec3& direction) {
    if (count == 0) return;
    at += glm::dot(axis, direction) > 0 ? 1 : -1;
    if (at < 0 || at >= count) count = 0;
  }
};

// Surface::rayOffset of a triangle that shares its place (World::sharedPlaces), so that what is
// meant to lie in its plane counts as there.
float offsetAtPlace(const Scene& scene, const Surface& surface, const Hit& hit);

struct World;
class Media;

// For a light sample on an emitting triangle that shares its place (World::sharedPlaces): the part
// of its light that a path along the ray would find there, past the surfaces that it crosses first;
// 0 if it would meet another one. `emitter`: the point, as a hit of the ray; `media`: the media
// that the ray is in; `key`: as for Accel::intersect().
Rgb transmittanceAtPlace(const World& world, const Media& media, const Ray& ray, const Hit& emitter,
                         uint32_t key, RayMask mask);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "trace/room.h"

#include <algorithm>

#include "base/error.h"
#include "scene/surface.h"

namespace chromeball {
namespace {

// All walls are opaque, so that each ray and each light sample meets the same one.
Scene geometryOf(Scene model) {
  std::ranges::fill(model.materials, Material());
  return model;
}

}  // namespace

Room::Room(Scene model, const vec3& capture, const std::string& location)
    : scene_(geometryOf(std::move(model))), accel_(scene_), box_(bounds(scene_)) {
  constexpr float kMargin = 1e-4f;
  if (box_.empty()) throwInput("{}: the room has no triangles", location);
  margin_ = kMargin * glm::length(box_.max - box_.min);
  if (!glm::all(glm::lessThan(box_.min, capture)) || !glm::all(glm::lessThan(capture, box_.max)))
    throwInput("{}: `capture`, where the probe was taken, lies outside the room", location);
}

Surroundings::Point Room::behind(const vec3& origin, const vec3& direction) const {
  constexpr float kFar = 1e8f;  // times the margin
  const Ray ray{origin + margin_ * direction, direction};
  Hit hit;
  if (!accel_.intersect(ray, 0, hit)) return {origin + kFar * margin_ * direction, -direction};
  const Surface wall =
      surfaceAt(scene_, scene_.instances[hit.instance], hit.triangle, hit.barycentric, -direction);
  return {ray.origin + hit.distance * direction, wall.geometricNormal};
}

bool Room::isSeen(const vec3& point, const vec3& from) const {
  const vec3 to = point - from;
  const float distance = glm::length(to);
  if (!(distance > 2 * margin_)) return true;
  const vec3 direction = to / distance;
  return !isBlack(
      accel_.transmittance({from + margin_ * direction, direction, distance - 2 * margin_}));
}

}  // namespace chromeball

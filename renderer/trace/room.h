// SPDX-License-Identifier: Apache-2.0
// Surroundings that are a model of the room.
#pragma once

#include "scene/surroundings.h"
#include "trace/accel.h"

namespace chromeball {

// The triangles of a model, of which only the shape counts. They need be neither convex nor closed:
// through an opening a ray meets a sphere so far away that it is the distant probe.
class Room : public Walls {
 public:
  // `capture`: where the probe was taken. Throws InputError (beginning with `location`) for a model
  // without triangles, or one whose bounds do not hold `capture`.
  Room(Scene model, const vec3& capture, const std::string& location);

  // A wall that is nearer than 1e-4 of the room's size is passed: points
  // of the scene lie on it, and on either side by a rounding error.
  Surroundings::Point behind(const vec3& origin, const vec3& direction) const override;

  bool isSeen(const vec3& point, const vec3& from) const override;

  const Bounds& box() const { return box_; }

 private:
  Scene scene_;
  Accel accel_;
  Bounds box_;
  float margin_;
};

}  // namespace chromeball

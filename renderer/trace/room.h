// SPDX-License-Identifier: Apache-2.0
// Surroundings given by a model of the room.
#pragma once

#include "scene/bounds.h"
#include "scene/surroundings.h"
#include "trace/accel.h"

namespace chromeball {

// Uses only the geometry of a model; it need be neither convex nor closed. A ray that leaves
// through an opening hits a sphere so large that the probe seems infinitely distant.
class Room : public Walls {
 public:
  // `capture`: the position at which the probe was captured. Throws InputError (message beginning
  // with `location`) if the model has no triangles or its bounds do not contain `capture`.
  Room(Scene model, const vec3& capture, const std::string& location);

  // Ignores walls closer than 1e-4 of the room's size: points of the scene lie on walls, and by
  // rounding errors on either side of them.
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

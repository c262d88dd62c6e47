// SPDX-License-Identifier: Apache-2.0
// The bodies of glass that a path is inside of.
#pragma once

#include <array>

#include "scene/surface.h"
#include "shading/glass.h"

namespace chromeball {

// Bodies may lie within each other; where they overlap, the one entered last counts. Air surrounds
// them all, and the camera starts in it. More than four at once count as four.
class Media {
 public:
  bool inside() const { return count_ > 0; }

  // Share of light that passes `distance` metres of the medium here. Nothing absorbs without end:
  // what leaves an open mesh for the surroundings is left whole.
  Rgb transmittance(float distance) const {
    if (count_ == 0 || !std::isfinite(distance)) return Rgb(1);
    return glm::exp(-distance * bodies_[size_t(count_ - 1)]->extended->attenuation);
  }

  // The indices on both sides of the boundary of a body. Each channel has its own where the medium
  // disperses light (KHR_materials_dispersion); but light that is down to one channel has one.
  RefractiveIndex refractiveIndex(const Surface& boundary, const Rgb& throughput) const;

  // Follows a ray that leaves a surface towards `wi`: where it is refracted, into the body or out.
  Media& follow(const Surface& surface, const vec3& wi);

 private:
  int find(const Material* body) const;

  int count_ = 0;
  std::array<const Material*, 4> bodies_;
};

}  // namespace chromeball

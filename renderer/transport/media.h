// SPDX-License-Identifier: Apache-2.0
// The stack of dielectric bodies (glass) that contain the current path vertex.
#pragma once

#include <array>
#include <span>

#include "scene/surface.h"
#include "shading/glass.h"
#include "trace/ray.h"

namespace chromeball {

struct World;

// Bodies may be nested. Where they overlap, the one entered last determines the medium. The camera
// is in air, outside all bodies. At most four bodies are tracked; any further one is ignored.
class Media {
 public:
  // Those around the start of a path that does not come from the camera: `ray`, from there, leaves
  // them without having entered them. `key`, `mask`: as for Accel::intersect().
  static Media around(const World& world, Ray ray, uint32_t key, RayMask mask);

  bool inside() const { return count_ > 0; }
  std::span<const Material* const> bodies() const {
    return std::span(bodies_).first(size_t(count_));
  }

  // Whether the ray ignores the surface of a masked or blended body: its back, unless the ray is
  // inside, because then the ray has passed a gap in the front.
  bool ignores(const Material& material, bool frontFace) const {
    return !frontFace && material.alphaMode != AlphaMode::Opaque && material.isBody() &&
           find(&material) < 0;
  }

  // The attenuation coefficient of the current medium, 1/m.
  Rgb attenuation() const {
    return count_ == 0 ? Rgb(0) : bodies_[size_t(count_ - 1)]->extended->attenuation;
  }
  // Transmittance exp(-attenuation * distance) of the current medium; `distance` in metres. 1 for
  // an infinite distance: a ray that leaves an open mesh must not lose the probe's light.
  Rgb transmittance(float distance) const {
    if (count_ == 0 || !std::isfinite(distance)) return Rgb(1);
    return glm::exp(-distance * attenuation());
  }

  // The relative refractive index at a body's boundary. Per channel for a dispersive medium
  // (KHR_materials_dispersion), unless `throughput` has a single nonzero channel: then that
  // channel's index.
  RefractiveIndex refractiveIndex(const Surface& boundary, const Rgb& throughput) const;

  // Updates the stack for a ray that leaves `surface` in direction `wi`: a refracted ray enters or
  // leaves the body, a reflected ray changes nothing.
  Media& follow(const Surface& surface, const vec3& wi);

  // The last entered body with this material, as an index into bodies(); -1: none.
  int find(const Material* body) const;

 private:
  int count_ = 0;
  std::array<const Material*, 4> bodies_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The first surface of a camera path, for integrators that treat it in their own way.
#pragma once

#include "transport/path.h"

namespace chromeball {

struct FirstSurface {
  Hit hit;
  const Instance& instance;
  Surface surface;
  MaterialPoint material;

  FirstSurface(const Scene& scene, const Hit& found, const Surface& point)
      : hit(found),
        instance(scene.instances[found.instance]),
        surface(point),
        material(materialAt(scene, surface)) {}

  Bsdf bsdf(const PathTracer& tracer, const PathState& state) const;
};

// What the layers of the first hit show of a surface. `length`: of the path to it.
FirstHit firstHitAt(const Instance& instance, const vec3& normal, const Rgb& baseColor,
                    float length);

// The visible surface that the camera path `state` meets first, `hit` being the closest hit of its
// ray; also fills state.length and state.first. Nullopt if there is none: vertex() then adds the
// background.
std::optional<FirstSurface> firstSurface(const PathTracer& tracer, PathState& state,
                                         const std::optional<Hit>& hit, PathContext& context);

// The same for integrators that treat only reflected light in their own way: adds the background or
// emission that the path sees without reflection to `radiance`; nullopt if nothing is reflected.
std::optional<FirstSurface> firstReflector(const PathTracer& tracer, PathState& state,
                                           const std::optional<Hit>& hit, PathContext& context,
                                           Rgb& radiance);

}  // namespace chromeball

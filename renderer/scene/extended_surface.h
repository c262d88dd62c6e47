// The parameters of a material's extensions at a point: factors x textures.
#pragma once

#include "scene/surface.h"

namespace chromeball {

struct ExtendedPoint {
  float transmission = 0;
  bool thinWalled = true;
  float clearcoat = 0, clearcoatRoughness = 0;
  Rgb sheenColor{0};
  float sheenRoughness = 0;
  float anisotropy = 0;
  vec3 anisotropyTangent{0};  // unit, at right angles to the smooth normal
  float iridescence = 0, filmIor = 1, filmThickness = 0;  // nanometres
  vec3 clearcoatNormal{0};  // on the viewer's side, as Surface::normal
};

// The surface's material must be an extended one.
ExtendedPoint extendedMaterialAt(const Scene& scene, const Instance& instance,
                                 const Surface& surface);

}  // namespace chromeball

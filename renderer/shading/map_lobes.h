// SPDX-License-Identifier: Apache-2.0
// The lobes of a BSDF as environment mapping sees them (HDRI book, section 9.8.1).
#pragma once

#include <array>
#include <cassert>

#include "math/vec.h"

namespace chromeball {

struct MapLobe {
  Rgb albedo;       // towards the viewer: what it reflects of uniform radiance 1
  vec3 direction;   // unit: of a diffuse lobe the normal, else where its middle points
  bool isDiffuse;   // reflects the irradiance
  float roughness;  // perceptual, unless it is diffuse; 0 if it is smooth
};

// At most as many as a layered material has.
class MapLobes {
 public:
  void add(const MapLobe& lobe) {
    assert(count_ < lobes_.size());
    lobes_[count_++] = lobe;
  }
  void addDiffuse(const Rgb& albedo, const vec3& normal) { add({albedo, normal, true, 1}); }

  const MapLobe* begin() const { return lobes_.data(); }
  const MapLobe* end() const { return lobes_.data() + count_; }

 private:
  std::array<MapLobe, 12> lobes_;
  size_t count_ = 0;
};

// Which lobes a BSDF keeps where a limit of depth has been reached (PathSettings).
struct KeptLobes {
  bool diffuse = true, specular = true;
};

}  // namespace chromeball

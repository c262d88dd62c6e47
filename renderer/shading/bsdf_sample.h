// SPDX-License-Identifier: Apache-2.0
// Results of evaluating and sampling a BSDF.
#pragma once

#include <array>
#include <cassert>

#include "math/vec.h"

namespace chromeball {

// If a strategy replaces the probe by lights, narrow lobes would reflect them as separate
// highlights; so narrow lobes see the probe itself (LightSource::mirrorAlpha). A BSDF is the
// sum of its broad and its narrow lobes; each sum has its own samples, pdf and MIS weights.
enum class Lobes {
  Broad,
  Narrow,  // GGX with alpha below the limit; also perfect mirrors, for which evaluate() returns 0
};

struct BsdfValue {
  Rgb fCos;   // f times |cos| at the shading normal
  float pdf;  // of sample(), over solid angle
};

struct BsdfSample {
  vec3 wi;                 // unit, away from the surface
  Rgb weight;              // f |cos| / pdf, both of the lobes that were sampled
  float pdf;               // over solid angle; 0 for a delta
  Lobes lobes;             // that were sampled
  bool isDelta;            // wi is the only direction of a perfect mirror or a smooth refraction
  bool isDiffuse = false;  // a diffuse lobe chose the direction
};

// Completes a sample in the direction out.wi, for which out.lobes have `value`. Returns false if
// the pdf is 0. NaN passes, to be counted by the film.
inline bool completeSample(const BsdfValue& value, BsdfSample& out) {
  if (value.pdf <= 0) return false;
  out.weight = value.fCos / value.pdf;
  out.pdf = value.pdf;
  out.isDelta = false;
  return true;
}

// Completes a sample in the only direction of a delta lobe.
inline bool completeDelta(const Rgb& weight, BsdfSample& out) {
  out.weight = weight;
  out.pdf = 0;
  out.isDelta = true;
  return true;
}

// The lobes of a BSDF as environment mapping sees them (HDRI book, section 9.8.1).

struct MapLobe {
  Rgb albedo;       // radiance reflected towards the viewer under uniform radiance 1
  vec3 direction;   // unit: a diffuse lobe's normal, else where the lobe's middle points
  bool isDiffuse;   // reflects the irradiance
  float roughness;  // perceptual, unless it is diffuse; 0 if it is smooth
};

// The lobes: at most as many as a layered material has.
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

// The lobes that a BSDF keeps where a depth limit has been reached (PathSettings). `straight`:
// those of smooth sheets, which no limit by kind concerns.
struct KeptLobes {
  bool diffuse = true, specular = true, straight = true;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The seam on which everything the user compares hangs: one way of turning a probe into light.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "math/sampler.h"
#include "math/vec.h"
#include "probe/probe.h"

namespace chromeball {

class Bsdf;

// A point that receives light.
struct LightPoint {
  vec3 position;
  vec3 normal;             // shading normal, on the viewer's side
  const Bsdf* bsdf;        // null in escaped()
  int depth;               // 0 at the first hit: a strategy may do less on later bounces
  bool transmits = false;  // light from behind counts as well
};

// One direction for a shadow ray, as a directional light: `irradiance`, on a surface that faces it,
// is radiance / pdf. `pdf` is the effective pdf over solid angle, the sum over all samples taken
// together, so that the estimate is the sum over samples of
//   f cos * irradiance
// however many samples a strategy takes.
struct DirectionSample {
  vec3 wi;  // unit, from the point to the light
  Rgb irradiance;
  float pdf;             // unless isDelta
  bool isDelta = false;  // of a delta light: no BSDF sample can find it, so MIS leaves it whole
};

class LightingStrategy {
 public:
  virtual ~LightingStrategy() = default;

  // Appends zero or more samples. The vector keeps its capacity from call to call.
  virtual void sample(const LightPoint& point, const PixelSampler& sampler,
                      std::vector<DirectionSample>& out) const = 0;

  // What a ray that left `point` by the BSDF's choice and met nothing adds, and the pdf with
  // which sample() would have found that direction; 0 where it never does.
  struct Escaped {
    Rgb radiance;
    float pdf;
  };
  virtual Escaped escaped(const LightPoint& point, const vec3& wi) const = 0;

  // What the camera and mirrors at `origin` see, for which sample() has no competing estimate.
  virtual Rgb background(const vec3& origin, const vec3& wi) const = 0;

  // Specular lobes narrower than this (GGX's alpha) are not for sample(): of the probe they see
  // background(), as perfect mirrors do. Lamps of the scene light them like any other lobe.
  virtual float mirrorAlpha() const { return 0; }

  // False for an approximation, whose error does not vanish with the number of samples.
  virtual bool unbiased() const = 0;
};

// How light samples and BSDF samples of the same direction share it (Veach 1997).
enum class Mis { Off, Balance, Power };

// Builds a strategy from its name on the command line, "NAME" or "NAME:COUNT"; "auto" is the
// unbiased strategy best for the probe. `location` (an option, or FILE:LINE) begins the InputError
// thrown for an unknown name. The probe must outlive the strategy.
std::unique_ptr<LightingStrategy> makeStrategy(const std::string& name, const Probe& probe, Mis mis,
                                               const std::string& location);

// The name in full: what "auto" stands for, and the count where one was left out.
std::string resolveStrategy(const std::string& name);

// Every name but "auto", without counts.
std::vector<std::string_view> strategyNames();

}  // namespace chromeball

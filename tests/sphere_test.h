// SPDX-License-Identifier: Apache-2.0
// A chi-square test over the sphere of whether sampled directions follow their pdf.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "hypothesis.h"
#include "math/warp.h"

namespace chromeball {

// Integral of f over a rectangle, subdivided at least `minimum` times (so that the points do not
// miss a feature), then until a finer rule agrees.
double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0,
                 double y1, double tolerance, int minimum, int depth = 0);

struct SphereTest {
  ChiSquare chiSquare;
  double totalProbability;  // integral of the pdf
};

// Compares the numbers of `samples` directions from `draw` (nullopt: absorbed) in bins of equal
// solid angle (height along z x azimuth) with the integral of `pdf` over each bin.
SphereTest testDirections(const std::function<std::optional<vec3>(int)>& draw,
                          const std::function<double(const vec3&)>& pdf, int samples,
                          int minHalvings = 2, int heights = 24, int azimuths = 48);

// Independent random numbers for tests: sample i, dimension d.
inline float random1(int i, int d, uint64_t seed = 1) { return toUnit(uint32_t(hash(seed, i, d))); }
inline vec2 random2(int i, int d, uint64_t seed = 1) {
  return {random1(i, d, seed), random1(i, d + 1, seed)};
}

}  // namespace chromeball

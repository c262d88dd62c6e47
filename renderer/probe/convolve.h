// SPDX-License-Identifier: Apache-2.0
// Prefiltered environment maps: a probe blurred by a kernel (HDRI book, section 9.8.1).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The kernels of prefiltered environment maps: functions of the angle to the direction that is
// looked up. Not normalised; their integral over the sphere is integral().

class ZonalKernel {
 public:
  // max(0, cos)^exponent, at least 1: the map of a Phong lobe around the mirror direction (HDRI
  // book, section 9.8.1; Heidrich and Seidel 1999). Exponent 1 is irradiance / pi. Throws
  // InputError if the exponent is not in [1, 1e8].
  static ZonalKernel phong(double exponent);

  // D(h) max(0, cos): the GGX distribution at the half vector, alpha = roughness^2, weighted by the
  // cosine, seen along the normal (Karis 2013, "Real Shading in Unreal Engine 4"): the first factor
  // of the split sum. Roughness 1 is irradiance / pi. Throws InputError if the roughness is not in
  // [0.01, 1].
  static ZonalKernel ggx(double roughness);

  struct Value {
    double value, slope, curvature;  // the latter: first and second derivative by the cosine
  };
  Value at(double cosine) const;

  // Whether it is max(0, cos): irradiance / pi.
  bool isCosine() const { return parameter_ == 1; }

  // The angle from the axis, in radians, at which the kernel begins to fall.
  double width() const;

  // 2 pi times the integral over the cosine of the kernel times the Legendre polynomials P0, P1,
  // P2.
  std::array<double, 3> legendreMoments() const;
  double integral() const { return legendreMoments()[0]; }

 private:
  enum class Kind { Phong, Ggx };
  ZonalKernel(Kind kind, double parameter) : kind_(kind), parameter_(parameter) {}

  Kind kind_;
  double parameter_;  // the exponent, or alpha^2
};

// The mean of radiance under the kernel around each of the `directions` (unit). `latLong` is
// finite, not negative, and constant over each texel, of any size. Rectangles over which the kernel
// varies little are taken whole, with their first moments: for bright light the kernel is off
// by at most `error` of the sum of its value and its mean (for light below the map's mean, of the
// geometric mean of its value and its peak), the result by about `error` of itself and of the map's
// mean, also where all light is one texel's (twice that at most; tests/convolve_test.cpp). Never
// negative. Time is in proportion to 1 / error. A constant map keeps its value to 1e-6 (under a
// cosine to 6e-5: exactIrradiance()). Parallel; the same bits for any number of threads.
std::vector<dvec3> convolve(const Image& latLong, const ZonalKernel& kernel,
                            std::span<const vec3> directions, double error = 1e-3);

// The same from nine spherical harmonics (Ramamoorthi and Hanrahan 2001): blurred more than by a
// narrow kernel, and perhaps negative.
std::vector<dvec3> shConvolve(const Image& latLong, const ZonalKernel& kernel,
                              std::span<const vec3> directions);

}  // namespace chromeball

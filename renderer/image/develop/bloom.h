// SPDX-License-Identifier: Apache-2.0
// Bloom: an image blurred by a mixture of Gaussians, so that bright regions spread over their
// surroundings as in a lens or an eye (HDRI book, section 9.2.5; "Rendering with Natural Light").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"

namespace chromeball {

// The Gaussian filter of one line of pixels.

enum class GaussianMethod {
  Fast,   // as Exact up to kMaxExactSigma; above, from a line of lower resolution
  Exact,  // the kernel at full resolution, up to 6 sigma
};

inline constexpr double kMaxExactSigma = 8;

// The kernel is the integral of the Gaussian over each pixel,
//   k(d) = (erf((d + 1/2) / (sqrt2 sigma)) - erf((d - 1/2) / (sqrt2 sigma))) / 2,
// of variance sigma^2 + 1/12; so a square of a x a pixels (a odd) has erf(a / (2 sqrt2 sigma))^2 in
// its centre. The line is mirrored at its ends, and its sum is kept.
//
// Fast: with f = 2^n, 4 <= sigma / f < 8, cubic B-splines of f pixels per knot reduce the line; a
// Gaussian of standard deviation s filters it; the same splines interpolate. The variances are
// f^2/3, s^2 f^2 and f^2/3; s is chosen for the right sum. The kurtosis of the whole differs from
// the Gaussian's by -(f / sigma)^4 / 15, the kernel by less than 1e-4 of its peak.
class GaussianLine {
 public:
  // A filter for lines of `length` pixels; sigma in pixels, at least 0. 0 changes nothing.
  GaussianLine(double sigma, int length, GaussianMethod method);

  // Replaces the line by the filtered one. `scratch` is resized as needed.
  void apply(std::span<double> line, std::vector<double>& scratch) const;

  size_t work() const { return work_; }  // per pixel, as a number of elements (base/parallel.h)

 private:
  void applyTaps(std::span<const double> extended, std::span<double> filtered) const;
  void applyExact(std::span<double> line, std::vector<double>& scratch) const;
  void applyFast(std::span<double> line, std::vector<double>& scratch) const;
  void foldTaps(int length);

  // The interpolation for a pixel at one phase of a reduced pixel: the weights of four reduced
  // pixels, from `offset` on.
  struct Phase {
    int offset;
    std::array<double, 4> weights;
  };
  static Phase splinePhase(int phase, int factor);

  int factor_ = 1;             // f; 1: exact
  std::vector<Phase> phases_;  // one for each of f phases
  std::vector<double> taps_;   // of the distances 0, 1, ... to both sides
  size_t work_ = 1;
};

// Continues images beyond their borders: mirrored at the edge of the outermost pixel, again and
// again.

// The pixel of [0, n) that mirrors show at `i`: ... 1 0 | 0 1 ... n-1 | n-1 n-2 ... The period is
// 2n. A symmetric filter of sum 1 keeps the sum of an image that continues like this.
inline int mirrored(int64_t i, int n) {
  if (i >= 0 && i < n) return int(i);
  const int64_t period = 2 * int64_t(n);
  i %= period;
  if (i < 0) i += period;
  return int(i < n ? i : period - 1 - i);
}

// Mixtures of Gaussians.

struct WeightedGaussian {
  double weight;
  double sigma;  // pixels
};

inline constexpr double kMaxSigma = 4096;

// Blurs all channels by the separable Gaussian of GaussianLine, in place. Infinity and NaN
// spread.
void blurGaussian(Image& image, double sigma, GaussianMethod method);

// The sum of weight x Gaussian(sigma) * image. Keeps the sum of the pixels if the weights sum to 1.
// Needs the memory of two more images.
Image bloom(const Image& image, const std::vector<WeightedGaussian>& mixture,
            GaussianMethod method);

// Glare of the human eye as a mixture of Gaussians.

// The point spread function of the eye adapted to daylight (Spencer, Shirley, Zimmerman and
// Greenberg, "Physically-Based Glare Effects for Digital Images", SIGGRAPH 1995), per steradian,
// `angle` in degrees:
//   0.384 f0 + 0.478 f1 + 0.138 f2,
//   f0 = 2.61e6 exp(-(angle / 0.02)^2), f1 = 20.91 / (angle + 0.02)^3, f2 = 72.37 / (angle +
//   0.02)^2,
// each of integral 1 over the hemisphere. Its flare lines (ciliary corona) are left out; the halo
// of the lens occurs only for the eye in the dark.
double spencerSpread(double angle);

// Gaussians that sum to it within 2% from 0.1 to 8 degrees, with weights that sum to 1; all pixels
// count as large as in the middle of the picture. The light of Gaussians narrower than a tenth of a
// pixel, and of the function beyond Gaussians of 30 degrees or kMaxSigma, stays in the pixel.
std::vector<WeightedGaussian> spencerGlare(double pixelsPerDegree);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// FLIP for images of high dynamic range: the maximum over exposures.
#include <algorithm>
#include <cmath>
#include <vector>

#include "measure/flip.h"

namespace chromeball {
namespace {

using dvec3 = glm::dvec3;

// The tone mapper (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kA = 0.36 * 2.51, kB = 0.6 * 0.03, kC = 0.36 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

double toneMapped(double x) { return (kA * x * x + kB * x) / (kC * x * x + kD * x + kE); }

// The x for which toneMapped(x) = y.
double inverseToneMapped(double y) {
  const double a = kA - kC * y, b = kB - kD * y, c = -kE * y;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Image exposed(const Image& image, double stops) {
  Image result(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const dvec3 c = glm::max(dvec3(image.rgb(x, y)), dvec3(0)) * std::exp2(stops);
      result.setRgb(x, y, Rgb(toneMapped(c.x), toneMapped(c.y), toneMapped(c.z)));
    }
  return result;
}

}  // namespace

Image hdrFlip(const Image& reference, const Image& test, double pixelsPerDegree) {
  std::vector<double> luminances;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x)
      luminances.push_back(std::max(luminance(reference.rgb(x, y)), 1e-6f));
  std::sort(luminances.begin(), luminances.end());
  const double target = inverseToneMapped(0.85);
  const double start = std::log2(target / luminances.back());
  const double stop = std::log2(target / luminances[(luminances.size() - 1) / 2]);
  const int exposures = std::max(2, int(std::ceil(stop - start)));

  Image maximum(reference.width, reference.height, 1);
  for (int i = 0; i < exposures; ++i) {
    const double stops = start + (stop - start) * i / (exposures - 1);
    const Image error = flip(exposed(reference, stops), exposed(test, stops), pixelsPerDegree);
    for (size_t p = 0; p < maximum.texels.size(); ++p)
      maximum.texels[p] = std::max(maximum.texels[p], error.texels[p]);
  }
  return maximum;
}

}  // namespace chromeball

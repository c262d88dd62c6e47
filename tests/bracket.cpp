// SPDX-License-Identifier: Apache-2.0
#include "bracket.h"

#include <algorithm>
#include <cmath>

#include "image/tonemap.h"

namespace chromeball {

double encodeSrgb(double exposure) { return linearToSrgb(float(exposure)); }

Image photographed(const Image& radiance, const dvec3& factor, const Encoding& encode, int steps) {
  Image levels(radiance.width, radiance.height, 3);
  for (size_t i = 0; i < levels.texels.size(); ++i) {
    const double level =
        std::min(encode(std::min(radiance.texels[i] * factor[int(i % 3)], 1.0)), 1.0);
    levels.texels[i] = float(steps > 0 ? std::round(level * steps) / steps : level);
  }
  return levels;
}

std::vector<Exposure> bracket(const Image& radiance, const std::vector<double>& factors,
                              const Encoding& encode, int steps) {
  std::vector<Exposure> exposures;
  for (size_t i = 0; i < factors.size(); ++i)
    exposures.push_back({std::to_string(i + 1),
                         photographed(radiance, dvec3(factors[i]), encode, steps),
                         dvec3(factors[i])});
  return exposures;
}

Image ramp(int width, int height, double low, double high) {
  Image image(width, height, 3);
  const auto at = [&](double part) { return float(low * std::pow(high / low, part)); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + (y + 0.5) / height) / width;
      image.setRgb(x, y, {at(u), at(1 - u), at(0.5 + 0.5 * std::sin(9.0 * u + 12.0 * y / height))});
    }
  return image;
}

}  // namespace chromeball

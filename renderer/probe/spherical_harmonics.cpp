// SPDX-License-Identifier: Apache-2.0
#include "probe/spherical_harmonics.h"

#include "probe/solid_angle.h"

namespace chromeball {

std::array<double, kShCount> shBasis(const dvec3& d) {
  const double l0 = 0.5 * std::sqrt(1 / kPiD), l1 = 0.5 * std::sqrt(3 / kPiD);
  const double l2 = 0.5 * std::sqrt(15 / kPiD), l20 = 0.25 * std::sqrt(5 / kPiD);
  return {l0,
          l1 * d.y,
          l1 * d.z,
          l1 * d.x,
          l2 * d.x * d.y,
          l2 * d.y * d.z,
          l20 * (3 * d.z * d.z - 1),
          l2 * d.x * d.z,
          0.5 * l2 * (d.x * d.x - d.y * d.y)};
}

ShCoefficients projectSh(const Image& latLong) {
  ShCoefficients coefficients{};
  const int w = latLong.width, h = latLong.height;
  for (int y = 0; y < h; ++y) {
    const double solidAngle = texelSolidAngle(y, w, h);
    for (int x = 0; x < w; ++x) {
      const std::array<double, kShCount> basis = shBasis(texelDirection({w, h}, x, y));
      const dvec3 flux = dvec3(latLong.rgb(x, y)) * solidAngle;
      for (int i = 0; i < kShCount; ++i) coefficients[i] += basis[i] * flux;
    }
  }
  return coefficients;
}

dvec3 shConvolution(const ShCoefficients& radiance, const std::array<double, 3>& moments,
                    const dvec3& direction) {
  const auto [zero, one, two] = moments;
  const std::array<double, kShCount> factors{zero, one, one, one, two, two, two, two, two};
  const std::array<double, kShCount> basis = shBasis(direction);
  dvec3 sum(0);
  for (int i = 0; i < kShCount; ++i) sum += factors[i] * basis[i] * radiance[i];
  return sum;
}

dvec3 shIrradiance(const ShCoefficients& radiance, const dvec3& normal) {
  return shConvolution(radiance, {kPiD, 2 * kPiD / 3, kPiD / 4}, normal);
}

}  // namespace chromeball

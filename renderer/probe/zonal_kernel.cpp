// SPDX-License-Identifier: Apache-2.0
#include "probe/zonal_kernel.h"

#include <cmath>

#include "base/error.h"
#include "math/vec.h"

namespace chromeball {

ZonalKernel ZonalKernel::phong(double exponent) {
  if (!(exponent >= 1 && exponent <= 1e8))
    throwInput("phong: the exponent {} should be from 1 to 1e8", exponent);
  return {Kind::Phong, exponent};
}

ZonalKernel ZonalKernel::ggx(double roughness) {
  if (!(roughness >= 0.01 && roughness <= 1))
    throwInput("ggx: the roughness {} should be from 0.01 to 1; a mirror shows the map as it is",
               roughness);
  const double alpha = roughness * roughness;
  return {Kind::Ggx, alpha * alpha};
}

double ZonalKernel::width() const {
  return kind_ == Kind::Phong ? 1 / std::sqrt(parameter_) : std::sqrt(parameter_);
}

// With the half vector at half the angle, D is proportional to 1 / q^2, q = 1 - (1 - alpha^2)
// cos^2(angle / 2) = alpha^2 + (1 - alpha^2)(1 - cos) / 2.
ZonalKernel::Value ZonalKernel::at(double cosine) const {
  if (cosine <= 0) return {0, 0, 0};
  if (kind_ == Kind::Phong) {
    const double n = parameter_, power = std::pow(cosine, n - 1);
    return {power * cosine, n * power, n * (n - 1) * power / cosine};
  }
  // alpha^4 / q^2, which is 1 on the axis.
  const double b = (1 - parameter_) / parameter_, q = 1 + b * (1 - cosine) / 2, bq = b / q;
  return {cosine / (q * q), (1 + cosine * bq) / (q * q), bq * (2 + 1.5 * cosine * bq) / (q * q)};
}

std::array<double, 3> ZonalKernel::legendreMoments() const {
  if (kind_ == Kind::Phong || isCosine()) {  // a cosine is the lobe of exponent 1
    const double n = parameter_, zero = 2 * kPiD / (n + 1);
    return {zero, 2 * kPiD / (n + 2), (3 * 2 * kPiD / (n + 3) - zero) / 2};
  }
  // Over t = (1 - cos) / 2 = (exp(s) - 1) / b, in which 1 / q^2 = exp(-2 s): Simpson's
  // rule in s, to 1e-9.
  constexpr int kSteps = 2048;
  const double b = 1 / parameter_ - 1, step = std::log1p(b / 2) / kSteps;
  std::array<double, 3> moments{};
  for (int i = 0; i <= kSteps; ++i) {
    const double s = step * i, cosine = 1 - 2 * std::expm1(s) / b;
    const double weight = (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * step / 3;
    const double value = 4 * kPiD * weight * cosine * std::exp(-s) / b;
    moments[0] += value;
    moments[1] += value * cosine;
    moments[2] += value * (3 * cosine * cosine - 1) / 2;
  }
  return moments;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "relight/sh_basis.h"

#include <cmath>

namespace chromeball {

// Y_lm = Q_lm(z) times the real (m >= 0) or imaginary (m < 0) part of (x + i y)^|m|, with Q_lm the
// normalised Legendre function divided by sin(theta)^|m|, a polynomial.
void shBasis(const dvec3& d, int order, std::span<double> out) {
  const auto at = [&](int l, int m) -> double& { return out[size_t(l * (l + 1) + m)]; };
  double real = 1, imaginary = 0;  // (x + i y)^m
  double diagonal = std::sqrt(1 / (4 * kPiD));
  for (int m = 0; m <= order; ++m) {
    if (m > 0) {
      diagonal *= std::sqrt((2 * m + 1.) / (2 * m));
      const double next = real * d.x - imaginary * d.y;
      imaginary = real * d.y + imaginary * d.x;
      real = next;
    }
    const double scale = m == 0 ? 1 : std::sqrt(2.);
    double before = 0, q = diagonal;
    for (int l = m; l <= order; ++l) {
      if (l > m) {
        const double a = std::sqrt((4. * l * l - 1) / (l * l - m * m));
        const double b = std::sqrt(((l - 1.) * (l - 1) - m * m) / (4. * (l - 1) * (l - 1) - 1));
        const double next = a * (d.z * q - b * before);
        before = q;
        q = next;
      }
      at(l, m) = scale * q * real;
      if (m > 0) at(l, -m) = scale * q * imaginary;
    }
  }
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/sh_bands.h"

#include <array>

#include "probe/solid_angle.h"

namespace chromeball {
namespace {

constexpr size_t indexOf(int l, int m) { return size_t(l * (l + 1) + m); }

// sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), times sqrt(2) for m > 0.
double normalization(int l, int m) {
  double ratio = 1;
  for (int i = l - m + 1; i <= l + m; ++i) ratio /= i;
  return std::sqrt((m > 0 ? 2 : 1) * (2 * l + 1) * ratio / (4 * kPiD));
}

using Normalizations = std::array<double, shCountOf(kMaxShOrder)>;

Normalizations normalizations() {
  Normalizations all{};
  for (int l = 0; l <= kMaxShOrder; ++l)
    for (int m = 0; m <= l; ++m) all[indexOf(l, m)] = normalization(l, m);
  return all;
}

}  // namespace

// The associated Legendre function of (l, m), without its factor sin^m, follows from those of
// (l - 1, m) and (l - 2, m); sin^m cos(m phi) and sin^m sin(m phi) are the parts of (x + i y)^m.
void shBasis(const dvec3& d, int order, std::span<double> out) {
  static const Normalizations kFactors = normalizations();
  double diagonal = 1, real = 1, imaginary = 0;  // (2 m - 1)!!, (x + i y)^m
  for (int m = 0; m <= order; ++m) {
    double before = 0, legendre = diagonal;
    for (int l = m; l <= order; ++l) {
      const double scaled = kFactors[indexOf(l, m)] * legendre;
      out[indexOf(l, m)] = scaled * real;
      if (m > 0) out[indexOf(l, -m)] = scaled * imaginary;
      const double next = ((2 * l + 1) * d.z * legendre - (l + m) * before) / (l - m + 1);
      before = legendre;
      legendre = next;
    }
    diagonal *= 2 * m + 1;
    const double turned = real * d.x - imaginary * d.y;
    imaginary = real * d.y + imaginary * d.x;
    real = turned;
  }
}

std::vector<dvec3> projectSh(const Image& latLong, int order, const Rotation& rotation) {
  std::vector<dvec3> coefficients(size_t(shCountOf(order)), dvec3(0));
  std::vector<double> basis(coefficients.size());
  const int w = latLong.width, h = latLong.height;
  for (int y = 0; y < h; ++y) {
    const double solidAngle = texelSolidAngle(y, w, h);
    for (int x = 0; x < w; ++x) {
      shBasis(rotation(texelDirection({w, h}, x, y)), order, basis);
      const dvec3 flux = dvec3(latLong.rgb(x, y)) * solidAngle;
      for (size_t i = 0; i < basis.size(); ++i) coefficients[i] += basis[i] * flux;
    }
  }
  return coefficients;
}

double shCosineFactor(int band) {
  if (band == 1) return 2 * kPiD / 3;
  if (band % 2 == 1) return 0;
  // 2 pi (-1)^(l/2 - 1) / ((l + 2)(l - 1)) l! / (2^l (l/2)!^2)
  double factor = 2 * kPiD / ((band + 2) * (band - 1));
  for (int i = 1; i <= band / 2; ++i) factor *= double(band / 2 + i) / (4 * i);
  return band / 2 % 2 == 0 ? -factor : factor;
}

}  // namespace chromeball

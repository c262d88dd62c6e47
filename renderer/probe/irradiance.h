// SPDX-License-Identifier: Apache-2.0
// Irradiance from a probe on surfaces of any orientation.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "math/vec.h"
#include "probe/mapping.h"

namespace chromeball {

// E(n) = integral over all directions of radiance x max(0, n . direction), in W/m^2, for each of
// `normals` (unit) (Madsen and Laursen 2007, eq. 1 to 4). `latLong` is finite and constant over
// each texel, of any size. In azimuth the integral is exact; in the polar angle the horizon of n
// cuts a row, at least 1/128 of the map high, where it cuts its mean direction: too little light,
// by at most 6e-5 of E for a constant map. Rounding adds less than 1e-12 of the largest E.
// Parallel; the same bits for any number of threads.
std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals);

// The same from nine spherical harmonics: fast, with an error of 1 to 10% on real probes,
// and negative about 120 degrees away from suns.
std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals);

// The directions of the texel centres of a lat-long map, row by row: the normals of an irradiance
// map.
std::vector<vec3> texelDirections(const ImageSize& latLong);

// The same for the environment that `rotation` turns: directions in the map, which is not turned.
std::vector<vec3> texelDirections(const ImageSize& latLong, const Rotation& rotation);

// Three channels; one colour a texel, row by row.
Image imageOf(const ImageSize& size, std::span<const dvec3> colors);

// Lat-long irradiance maps at those normals, three channels, of the environment that `rotation`
// turns.
Image irradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation = {});
Image shIrradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation = {});

// Integrals over the part of a row of a lat-long map that lies above the horizon of a surface.
// Azimuth phi = 2 pi u: the direction is (-sin(theta) sin(phi), cos(theta), sin(theta) cos(phi)).

struct Azimuth {
  double phi, cos, sin;  // phi in [0, 2 pi]
};

// The azimuths from `begin` to `end`, across the seam if `end` is less.
struct Arc {
  enum class Kind { Empty, Part, Whole } kind = Kind::Empty;
  Azimuth begin{}, end{};
};

// The half of the directions in which a surface with this normal (unit) is lit.
class Horizon {
 public:
  explicit Horizon(const vec3& normal);

  // The azimuths of the directions above it, for directions whose cosine to +Y and whose sine are
  // proportional to these (sine >= 0).
  Arc above(double sine, double cosine) const;

  const glm::dvec3& normal() const { return normal_; }

 private:
  glm::dvec3 normal_;
  Azimuth azimuth_;    // of the normal
  double horizontal_;  // length of the normal's projection
};

// The row from theta0 to theta1 integrated over theta: sin^2 and sin cos, which are the weights of
// the horizontal and the vertical part of a cosine.
struct PolarMoments {
  double sine2, sineCosine;
  PolarMoments(double theta0, double theta1);
};

// Antiderivatives, at the edges of a row's texels, of 1, cos(phi), sin(phi), cos^2(phi) and
// sin(phi) cos(phi), or of the first of these.
template <int kTerms>
using AzimuthTable = std::vector<std::array<double, kTerms>>;

template <int kTerms>
std::array<double, kTerms> antiderivatives(const Azimuth& a) {
  static_assert(kTerms == 3 || kTerms == 5);
  if constexpr (kTerms == 3)
    return {a.phi, a.sin, -a.cos};
  else
    return {a.phi, a.sin, -a.cos, (a.phi + a.sin * a.cos) / 2, a.sin * a.sin / 2};
}

template <int kTerms>
AzimuthTable<kTerms> azimuthTable(int width) {
  AzimuthTable<kTerms> table;
  for (int x = 0; x <= width; ++x) {
    const double phi = 2 * kPiD * x / width;
    table.push_back(antiderivatives<kTerms>({phi, std::cos(phi), std::sin(phi)}));
  }
  return table;
}

// Integrals over azimuth of a vector that is constant over each texel of a row, times each of those
// functions. A tree of sums answers for any arc without subtracting what lies outside it: a sun
// there leaves no rounding error.
template <class Vector, int kTerms>
class RowIntegrals {
 public:
  using Terms = std::array<Vector, kTerms>;

  // `table` must outlive this.
  RowIntegrals(const AzimuthTable<kTerms>& table, std::vector<Vector> texels)
      : table_(&table), texels_(std::move(texels)), tree_(2 * texels_.size()) {
    const size_t width = texels_.size();
    for (size_t x = 0; x < width; ++x) add(tree_[width + x], texels_[x], table[x + 1], table[x]);
    for (size_t i = width - 1; i > 0; --i) {
      tree_[i] = tree_[2 * i];
      add(tree_[i], tree_[2 * i + 1]);
    }
  }

  Terms over(const Arc& arc) const {
    Terms sum{};
    const size_t width = texels_.size();
    if (arc.kind == Arc::Kind::Empty) return sum;
    if (arc.kind == Arc::Kind::Whole) {
      addTexels(0, width, sum);
      return sum;
    }
    const size_t first = texelAt(arc.begin), last = texelAt(arc.end);
    const auto begin = antiderivatives<kTerms>(arc.begin), end = antiderivatives<kTerms>(arc.end);
    if (arc.begin.phi <= arc.end.phi && first == last) {
      add(sum, texels_[first], end, begin);
      return sum;
    }
    add(sum, texels_[first], (*table_)[first + 1], begin);
    add(sum, texels_[last], end, (*table_)[last]);
    if (arc.begin.phi <= arc.end.phi) {
      addTexels(first + 1, last, sum);
    } else {
      addTexels(first + 1, width, sum);
      addTexels(0, last, sum);
    }
    return sum;
  }

 private:
  size_t texelAt(const Azimuth& a) const {
    return std::min(size_t(a.phi * double(texels_.size()) / (2 * kPiD)), texels_.size() - 1);
  }
  static void add(Terms& sum, const Vector& texel, const std::array<double, kTerms>& to,
                  const std::array<double, kTerms>& from) {
    for (int i = 0; i < kTerms; ++i) sum[i] += texel * (to[i] - from[i]);
  }
  static void add(Terms& sum, const Terms& addend) {
    for (int i = 0; i < kTerms; ++i) sum[i] += addend[i];
  }
  // Node i of the tree is the sum of nodes 2 i and 2 i + 1; the texels are the leaves.
  void addTexels(size_t begin, size_t end, Terms& sum) const {
    const size_t width = texels_.size();
    for (begin += width, end += width; begin < end; begin /= 2, end /= 2) {
      if (begin % 2 == 1) add(sum, tree_[begin++]);
      if (end % 2 == 1) add(sum, tree_[--end]);
    }
  }

  const AzimuthTable<kTerms>* table_;
  std::vector<Vector> texels_;
  std::vector<Terms> tree_;
};

// Spherical harmonics to order 2: nine coefficients per channel.

// L00, L1-1, L10, L11, L2-2, L2-1, L20, L21, L22.
inline constexpr int kShCount = 9;
using ShCoefficients = std::array<dvec3, kShCount>;

// The real basis Y_lm at a unit direction. Y10 is proportional to z, which points towards the
// viewer here. (In Ramamoorthi and Hanrahan 2001 z points into the image, so their L10, L2-1 and
// L21 have the opposite sign.)
std::array<double, kShCount> shBasis(const dvec3& direction);

// L_lm = integral of radiance x Y_lm over the sphere, for a lat-long map that is constant over each
// texel: Y_lm at the centres of its parts, of at most 1.4 degrees, times their exact solid
// angles.
ShCoefficients projectSh(const Image& latLong);

// The convolution with a function of the angle to `direction` (unit) that has these Legendre
// moments, 2 pi times its integrals over the cosine times P0, P1 and P2 (Ramamoorthi and Hanrahan
// 2001, eq. 7).
dvec3 shConvolution(const ShCoefficients& radiance, const std::array<double, 3>& moments,
                    const dvec3& direction);

// Irradiance on a surface with unit `normal`: sum of A_l L_lm Y_lm(normal), with A_0 = pi,
// A_1 = 2 pi / 3, A_2 = pi / 4 (Ramamoorthi and Hanrahan 2001, eq. 8). Bands above 2 hold less than
// 1% of the squared irradiance over all normals, but the error is larger: over 21 captured probes
// the mean absolute error is 1 to 10% of the mean irradiance and the maximum 4 to 30%; next to suns
// and lamps the sum can be negative.
dvec3 shIrradiance(const ShCoefficients& radiance, const dvec3& normal);

}  // namespace chromeball

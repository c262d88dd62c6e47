// SPDX-License-Identifier: Apache-2.0
// Integrals over the part of a row of a lat-long map that lies above the horizon of a surface.
// Azimuth phi = 2 pi u: the direction is (-sin(theta) sin(phi), cos(theta), sin(theta) cos(phi)).
#pragma once

#include <array>
#include <vector>

#include "math/vec.h"

namespace chromeball {

struct Azimuth {
  double phi, cos, sin;  // phi in [0, 2 pi]
};

// The azimuths from `begin` on to `end`, over the seam where that is less.
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

}  // namespace chromeball

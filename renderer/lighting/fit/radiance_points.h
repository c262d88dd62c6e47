// SPDX-License-Identifier: Apache-2.0
// A probe as a small number of directional lights, for repeated sums over all of them.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The integral over all normals of the probe's irradiance x the pattern max(0, n . d) of a light
// from d (light_descent.h), and its derivative: along a unit tangent t of d, channel c of the
// product changes by dot(t, slope[c]).
struct PatternProduct {
  dvec3 product;   // RGB
  dvec3 slope[3];  // of R, G, B
};

// Four points in one register (vector extension of GCC and Clang).
inline constexpr int kRadianceLanes = 4;
typedef double RadianceLanes __attribute__((vector_size(kRadianceLanes * sizeof(double))));

class RadiancePoints {
 public:
  // Merges blocks of texels so that at most `maxRows` rows and twice as many columns remain. The
  // direction of a block is the mean, weighted by the sum of the channels. A smaller map keeps its
  // texels, which are divided if it has fewer than 16 rows or 32 columns. `scale` multiplies all
  // radiance.
  RadiancePoints(const Image& latLong, int maxRows, double scale);

  PatternProduct productWith(const dvec3& direction) const;
  const dvec3& flux() const { return flux_; }  // the sum of all irradiances

 private:
  // A structure of arrays; the last group is padded with black points.
  struct Group {
    RadianceLanes x{}, y{}, z{};  // unit direction
    RadianceLanes rgb[3]{};       // irradiance on a surface that faces it
  };
  void add(size_t index, const dvec3& direction, const dvec3& irradiance);

  std::vector<Group> groups_;
  dvec3 flux_{0};
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A probe as points of light, few enough to be summed over again and again.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// The product, over all normals, of the probe's irradiance with the pattern max(0, n . d) of a
// light from d (cosine_pattern.h), and its derivative: along a unit tangent t of d the product
// changes by dot(t, slope[c]) in channel c.
struct PatternProduct {
  dvec3 product;   // RGB
  dvec3 slope[3];  // of R, G, B
};

// Four points in one register: GCC's and Clang's vector extension.
inline constexpr int kRadianceLanes = 4;
typedef double RadianceLanes __attribute__((vector_size(kRadianceLanes * sizeof(double))));

class RadiancePoints {
 public:
  // Blocks of texels are merged until no more than `maxRows` rows (and twice as many columns) are
  // left, each block into its mean direction, weighted by the sum of its channels. A map that is
  // small enough keeps its texels. `scale` multiplies all radiance.
  RadiancePoints(const Image& latLong, int maxRows, double scale);

  PatternProduct productWith(const dvec3& direction) const;
  const dvec3& flux() const { return flux_; }  // the sum of all irradiances

 private:
  // Points side by side; the last ones pad with black.
  struct Group {
    RadianceLanes x{}, y{}, z{};  // unit direction
    RadianceLanes rgb[3]{};       // irradiance on a surface that faces it
  };
  void add(size_t index, const dvec3& direction, const dvec3& irradiance);

  std::vector<Group> groups_;
  dvec3 flux_{0};
};

}  // namespace chromeball

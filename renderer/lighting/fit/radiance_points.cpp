// SPDX-License-Identifier: Apache-2.0
#include "lighting/fit/light_descent.h"

namespace chromeball {
namespace {

using Lanes = RadianceLanes;

Lanes squareRoot(Lanes a) {
  Lanes root;
  for (int i = 0; i < kRadianceLanes; ++i) root[i] = std::sqrt(a[i]);
  return root;
}

// acos for |x| <= 1 with an error of 2e-8 (Abramowitz and Stegun, eq. 4.4.46).
Lanes arcCosine(Lanes x) {
  const Lanes a = x < 0 ? -x : x;
  const Lanes polynomial =
      1.5707963050 +
      a * (-0.2145988016 +
           a * (0.0889789874 +
                a * (-0.0501743046 +
                     a * (0.0308918810 +
                          a * (-0.0170881256 + a * (0.0066700901 + a * -0.0012624911))))));
  const Lanes positive = squareRoot(1 - a) * polynomial;
  return x < 0 ? kPiD - positive : positive;
}

}  // namespace

RadiancePoints::RadiancePoints(const Image& latLong, int maxRows, double scale) {
  // Texels of coarser maps are divided: a point in the middle of one has another irradiance.
  constexpr int kMinRows = 16, kMinColumns = 32;
  const int partsX = (kMinColumns + latLong.width - 1) / latLong.width;
  const int partsY = (kMinRows + latLong.height - 1) / latLong.height;
  const int w = latLong.width * partsX, h = latLong.height * partsY;
  const int rows = std::min(h, maxRows), columns = std::min(w, 2 * maxRows);
  std::vector<dvec2> azimuths(w);  // x, z
  for (int x = 0; x < w; ++x) {
    const dvec3 d = *uvToDirection(Mapping::LatLong, {(x + 0.5) / w, 0.5});
    azimuths[x] = {d.x, d.z};
  }
  size_t count = 0;
  for (int row = 0; row < rows; ++row) {
    std::vector<dvec3> moment(columns, dvec3(0)), flux(columns, dvec3(0));
    for (int y = int(int64_t(row) * h / rows); y < int64_t(row + 1) * h / rows; ++y) {
      const double solidAngle = texelSolidAngle(y, w, h), theta = kPiD * (y + 0.5) / h;
      for (int x = 0; x < w; ++x) {
        const dvec3 texelFlux = dvec3(latLong.rgb(x / partsX, y / partsY)) * (solidAngle * scale);
        const dvec3 direction(azimuths[x].x * std::sin(theta), std::cos(theta),
                              azimuths[x].y * std::sin(theta));
        const size_t column = size_t(int64_t(x) * columns / w);
        flux[column] += texelFlux;
        moment[column] += (texelFlux.x + texelFlux.y + texelFlux.z) * direction;
      }
    }
    for (int column = 0; column < columns; ++column) {
      const dvec3& f = flux[column];
      const double length = glm::length(moment[column]);
      // The irradiance on a surface that faces the block: length / sum of fluxes is its mean
      // cosine.
      if (length > 0) add(count++, moment[column] / length, f * (length / (f.x + f.y + f.z)));
    }
  }
}

void RadiancePoints::add(size_t index, const dvec3& direction, const dvec3& irradiance) {
  const size_t lane = index % kRadianceLanes;
  if (lane == 0) groups_.emplace_back();
  Group& group = groups_.back();
  group.x[lane] = direction.x, group.y[lane] = direction.y, group.z[lane] = direction.z;
  for (int c = 0; c < 3; ++c) group.rgb[c][lane] = irradiance[c];
  flux_ += irradiance;
}

PatternProduct RadiancePoints::productWith(const dvec3& d) const {
  Lanes products[3]{}, slopes[3][3]{};
  for (const Group& g : groups_) {
    Lanes cosine = g.x * d.x + g.y * d.y + g.z * d.z;
    cosine = cosine > 1 ? Lanes{} + 1 : cosine < -1 ? Lanes{} - 1 : cosine;
    const Lanes supplement = arcCosine(-cosine);
    const Lanes kernel = squareRoot(1 - cosine * cosine) + supplement * cosine;
    for (int c = 0; c < 3; ++c) {
      const Lanes weighted = g.rgb[c] * supplement;
      products[c] += g.rgb[c] * kernel;
      slopes[c][0] += weighted * g.x;
      slopes[c][1] += weighted * g.y;
      slopes[c][2] += weighted * g.z;
    }
  }
  const auto sum = [](Lanes lanes) {
    double total = 0;
    for (int i = 0; i < kRadianceLanes; ++i) total += lanes[i];
    return 2.0 / 3 * total;
  };
  PatternProduct result;
  for (int c = 0; c < 3; ++c) {
    result.product[c] = sum(products[c]);
    result.slope[c] = {sum(slopes[c][0]), sum(slopes[c][1]), sum(slopes[c][2])};
  }
  return result;
}

}  // namespace chromeball

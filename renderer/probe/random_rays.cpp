// SPDX-License-Identifier: Apache-2.0
#include "probe/random_rays.h"

#include "base/parallel.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

// Integrals of 1, the luminance L and L^2 over the same arcs, so that a constant probe has no
// variance.
using RaysRow = RowIntegrals<dvec3, 5>;

// Rows of coarser maps are divided (probe/irradiance.cpp).
constexpr int kMinRowsOfRays = 256;

RaysRow raysRowOf(const Image& latLong, int y, const AzimuthTable<5>& table) {
  std::vector<dvec3> texels;
  texels.reserve(size_t(latLong.width));
  for (int x = 0; x < latLong.width; ++x) {
    const double l = double(luminance(latLong.rgb(x, y)));
    texels.emplace_back(1, l, l * l);
  }
  return {table, std::move(texels)};
}

// The integrals over theta of the products of the parts of a squared cosine with sin(theta).
struct SquareMoments {
  double sine3, sine2Cosine, sineCosine2;

  // Simpson's rule: rows are flat.
  SquareMoments(double theta0, double theta1) : sine3(0), sine2Cosine(0), sineCosine2(0) {
    for (const auto& [at, weight] : {std::pair{0., 1.}, {0.5, 4.}, {1., 1.}}) {
      const double theta = theta0 + at * (theta1 - theta0), w = weight * (theta1 - theta0) / 6;
      const double s = std::sin(theta), c = std::cos(theta);
      sine3 += w * s * s * s, sine2Cosine += w * s * s * c, sineCosine2 += w * s * c * c;
    }
  }
};

// Integrals over a hemisphere of 1, L and L^2 times the cosine, and times its square.
struct Sums {
  dvec3 cosine{0}, cosine2{0};

  void add(const RaysRow& row, const PolarMoments& m, const SquareMoments& m2,
           const Horizon& horizon) {
    const auto [one, c, s, cc, sc] = row.over(horizon.above(m.sine2, m.sineCosine));
    const dvec3& n = horizon.normal();
    const dvec3 across = n.z * c - n.x * s;
    const dvec3 across2 = n.z * n.z * cc - 2 * n.z * n.x * sc + n.x * n.x * (one - cc);
    cosine += max(m.sine2 * across + m.sineCosine * n.y * one, dvec3(0));
    cosine2 += max(
        m2.sine3 * across2 + 2 * m2.sine2Cosine * n.y * across + m2.sineCosine2 * n.y * n.y * one,
        dvec3(0));
  }
};

std::vector<Sums> integrate(const Image& latLong, std::span<const vec3> normals) {
  const int height = latLong.height, parts = (kMinRowsOfRays + height - 1) / height;
  const AzimuthTable<5> table = azimuthTable<5>(latLong.width);
  const std::vector<Horizon> horizons(normals.begin(), normals.end());
  std::vector<Sums> sums(normals.size());
  for (int y = 0; y < height; ++y) {
    const RaysRow row = raysRowOf(latLong, y, table);
    parallelRanges(normals.size(), 64, [&](size_t begin, size_t end) {
      for (int part = 0; part < parts; ++part) {
        const double step = kPiD / (double(height) * parts), theta = step * (y * parts + part);
        const PolarMoments m(theta, theta + step);
        const SquareMoments m2(theta, theta + step);
        for (size_t i = begin; i < end; ++i) sums[i].add(row, m, m2, horizons[i]);
      }
    });
  }
  return sums;
}

// The variance over E^2 of an estimate with this mean square.
double relativeVariance(double meanSquare, double e) {
  return std::max(meanSquare / e / e - 1, 0.0);
}

}  // namespace

std::vector<RayVariance> rayVariances(const Image& latLong, std::span<const vec3> normals) {
  // Light that an arc beside a light gets by rounding does not count.
  constexpr double kRounding = 1e-13;
  const double sphere = 4 * kPiD * luminance(meanRadiance(latLong));
  std::vector<RayVariance> variances;
  for (const Sums& sums : integrate(latLong, normals)) {
    const double e = sums.cosine.y;
    // The sum of cosines is pi but for the rows cut by the horizon: with pi itself, a constant
    // probe would have a variance.
    variances.push_back(e > kRounding * sphere
                            ? RayVariance{e, relativeVariance(2 * kPiD * sums.cosine2.z, e),
                                          relativeVariance(sums.cosine.x * sums.cosine.z, e),
                                          relativeVariance(sphere * sums.cosine2.y, e)}
                            : RayVariance{});
  }
  return variances;
}

double raysForError(double relativeVariance, double error) {
  return std::max(1.0, std::ceil(relativeVariance / (error * error)));
}

}  // namespace chromeball

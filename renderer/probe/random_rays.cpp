// SPDX-License-Identifier: Apache-2.0
#include "probe/random_rays.h"

#include <tbb/parallel_for.h>

#include <array>

#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// Rows and columns of cells at least: texels of coarser maps are divided, because the cosine at a
// cell's centre stands for all of it.
constexpr int kMinRows = 256, kMinColumns = 512;

// The map's luminance on cells that are no larger than its texels.
struct Cells {
  int columns, rows, perTexelX, perTexelY;
  std::vector<float> luminances;  // of the texels
  std::vector<dvec2> azimuths;    // of the columns: x, z
  double sphere = 0;              // integral of luminance over all directions

  explicit Cells(const Image& latLong)
      : perTexelX((kMinColumns + latLong.width - 1) / latLong.width),
        perTexelY((kMinRows + latLong.height - 1) / latLong.height) {
    columns = perTexelX * latLong.width;
    rows = perTexelY * latLong.height;
    luminances.reserve(size_t(latLong.width) * latLong.height);
    for (int y = 0; y < latLong.height; ++y)
      for (int x = 0; x < latLong.width; ++x) luminances.push_back(luminance(latLong.rgb(x, y)));
    for (int x = 0; x < columns; ++x) {
      const double phi = 2 * kPiD * (x + 0.5) / columns;
      azimuths.emplace_back(-std::sin(phi), std::cos(phi));
    }
    for (int y = 0; y < latLong.height; ++y) {
      double row = 0;
      for (int x = 0; x < latLong.width; ++x)
        row += double(luminances[size_t(y) * latLong.width + x]);
      sphere += row * texelSolidAngle(y, latLong.width, latLong.height);
    }
  }
};

// Normals in a structure of arrays, which the compiler vectorises.
constexpr size_t kGroup = 8;
using Group = std::array<double, kGroup>;

// Integrals over a hemisphere.
struct Sums {
  Group cosine{};                             // of cos
  Group radianceCosine{}, radianceCosine2{};  // of L cos, L cos^2
  Group squareCosine{}, squareCosine2{};      // of L^2 cos, L^2 cos^2
};

Sums integrate(const Cells& cells, std::span<const vec3> normals) {
  Group nx{}, ny{}, nz{};
  for (size_t i = 0; i < normals.size(); ++i)
    nx[i] = normals[i].x, ny[i] = normals[i].y, nz[i] = normals[i].z;
  Sums sums;
  const int texelColumns = cells.columns / cells.perTexelX;
  for (int y = 0; y < cells.rows; ++y) {
    const double theta = kPiD * (y + 0.5) / cells.rows, sinTheta = std::sin(theta);
    const double solidAngle = texelSolidAngle(y, cells.columns, cells.rows);
    Group vertical;
    for (size_t i = 0; i < kGroup; ++i) vertical[i] = ny[i] * std::cos(theta);
    const float* row = &cells.luminances[size_t(y / cells.perTexelY) * texelColumns];
    for (int x = 0; x < cells.columns; ++x) {
      const double radiance = double(row[x / cells.perTexelX]);
      const dvec2 xz = sinTheta * cells.azimuths[x];
      for (size_t i = 0; i < kGroup; ++i) {
        const double dot = nx[i] * xz.x + vertical[i] + nz[i] * xz.y;
        const double cosine = dot > 0 ? dot : 0, c = solidAngle * cosine;
        const double lc = radiance * c, lc2 = lc * cosine;
        sums.cosine[i] += c;
        sums.radianceCosine[i] += lc;
        sums.radianceCosine2[i] += lc2;
        sums.squareCosine[i] += radiance * lc;
        sums.squareCosine2[i] += radiance * lc2;
      }
    }
  }
  return sums;
}

// The variance over E^2 of an estimate with this mean square.
double relativeVariance(double meanSquare, double e) {
  return e > 0 ? std::max(meanSquare / e / e - 1, 0.0) : 0;
}

}  // namespace

std::vector<RayVariance> rayVariances(const Image& latLong, std::span<const vec3> normals) {
  const Cells cells(latLong);
  std::vector<RayVariance> variances(normals.size());
  tbb::parallel_for(size_t(0), (normals.size() + kGroup - 1) / kGroup, [&](size_t group) {
    const size_t begin = group * kGroup, count = std::min(kGroup, normals.size() - begin);
    const Sums sums = integrate(cells, normals.subspan(begin, count));
    for (size_t i = 0; i < count; ++i) {
      const double e = sums.radianceCosine[i];
      // The sum of cosines is pi but for the cells cut by the horizon: with pi itself, a constant
      // probe would have a variance.
      variances[begin + i] = {e, relativeVariance(2 * kPiD * sums.squareCosine2[i], e),
                              relativeVariance(sums.cosine[i] * sums.squareCosine[i], e),
                              relativeVariance(cells.sphere * sums.radianceCosine2[i], e)};
    }
  });
  return variances;
}

double raysForError(double relativeVariance, double error) {
  return std::max(1.0, std::ceil(relativeVariance / (error * error)));
}

}  // namespace chromeball

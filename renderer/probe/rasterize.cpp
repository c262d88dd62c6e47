// SPDX-License-Identifier: Apache-2.0
#include "probe/rasterize.h"

#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// A weighted mean; black if nothing was added.
struct Mean {
  dvec3 sum{0};
  double weight = 0;

  void add(double w, const dvec3& radiance) {
    sum += w * radiance;
    weight += w;
  }
  operator Rgb() const { return weight > 0 ? Rgb(sum / weight) : Rgb(0); }
};

// Sines and cosines of the angles at the samples of one side of a lat-long map.
std::vector<dvec2> sinesAndCosines(int samples, double from, double to) {
  std::vector<dvec2> table(static_cast<size_t>(samples));
  for (int i = 0; i < samples; ++i) {
    const double angle = from + (to - from) * (i + 0.5) / samples;
    table[size_t(i)] = {std::sin(angle), std::cos(angle)};
  }
  return table;
}

// Faster for lat-long maps: azimuth depends on x alone and polar angle on y alone, so tables serve
// for both.
Image rasterizeLatLong(const ImageSize& size, int samplesPerSide,
                       const std::function<dvec3(const dvec3&)>& radiance) {
  Image out(size.width, size.height, 3);
  const int n = samplesPerSide;
  const std::vector<dvec2> phi = sinesAndCosines(n * size.width, -kPiD, kPiD);
  const std::vector<dvec2> theta = sinesAndCosines(n * size.height, 0, kPiD);
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      Mean mean;
      for (int j = n * y; j < n * (y + 1); ++j)
        for (int i = n * x; i < n * (x + 1); ++i) {
          const dvec2 &p = phi[size_t(i)], &t = theta[size_t(j)];
          mean.add(t.x, radiance({t.x * p.x, t.y, -t.x * p.y}));
        }
      out.setRgb(x, y, mean);
    }
  });
  return out;
}

}  // namespace

Image rasterize(Mapping mapping, const ImageSize& size, int samplesPerSide,
                const std::function<dvec3(const dvec3&)>& radiance) {
  if (mapping == Mapping::LatLong) return rasterizeLatLong(size, samplesPerSide, radiance);
  Image out(size.width, size.height, 3);
  const auto meanOverTexel = [&](int x, int y) {
    Mean mean;
    for (int j = 0; j < samplesPerSide; ++j)
      for (int i = 0; i < samplesPerSide; ++i) {
        const dvec2 uv((x + (i + 0.5) / samplesPerSide) / size.width,
                       (y + (j + 0.5) / samplesPerSide) / size.height);
        if (const std::optional<dvec3> direction = uvToDirection(mapping, uv))
          mean.add(solidAngleJacobian(mapping, uv), radiance(*direction));
      }
    return mean;
  };
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) out.setRgb(x, y, meanOverTexel(x, y));
  });
  return out;
}

}  // namespace chromeball

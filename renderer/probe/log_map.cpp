// SPDX-License-Identifier: Apache-2.0
#include "probe/log_map.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel.h"
#include "probe/convert.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

constexpr int kMedianHeight = 32;
constexpr float kFloor = 0.05f;

Image resized(const Image& latLong, int height) {
  return convert(latLong, Mapping::LatLong, Mapping::LatLong, {2 * height, height});
}

// Of one channel, over the sphere; of what is lit if it is 0; 1 if all is black.
float medianOf(const Image& map, int channel) {
  struct Texel {
    float radiance;
    double solidAngle;
  };
  std::vector<Texel> texels;
  double all = 0, lit = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      texels.push_back({map.at(x, y)[channel], texelSolidAngle(y, map.width, map.height)});
      all += texels.back().solidAngle;
      if (texels.back().radiance > 0) lit += texels.back().solidAngle;
    }
  std::ranges::sort(texels, {}, &Texel::radiance);
  double target = lit > 0.5 * all ? 0.5 * all : all - 0.5 * lit;
  for (const Texel& texel : texels)
    if ((target -= texel.solidAngle) < 0) return texel.radiance > 0 ? texel.radiance : 1;
  return 1;
}

// Weights of a Gaussian at -n .. n, of sum 1.
std::vector<float> gaussian(double sigma, int largest) {
  const int n = std::min(int(std::ceil(3 * sigma)), largest);
  std::vector<float> weights;
  double sum = 0;
  for (int i = -n; i <= n; ++i) sum += std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = -n; i <= n; ++i)
    weights.push_back(float(std::exp(-0.5 * i * i / (sigma * sigma)) / sum));
  return weights;
}

// Along the rows by 1 / sin(theta) texels, then along the meridians, over the poles, by one.
Image blurred(const Image& map) {
  const int width = map.width, height = map.height;
  Image along(width, height, 3), out(width, height, 3);
  forRows(width, height, 64, [&](int y) {
    const auto weights = gaussian(1 / std::sin(kPiD * (y + 0.5) / height), width / 2 - 1);
    const int n = int(weights.size()) / 2;
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      for (int i = -n; i <= n; ++i)
        sum += weights[size_t(i + n)] * map.rgb((x + i + width) % width, y);
      along.setRgb(x, y, sum);
    }
  });
  const auto weights = gaussian(1, height / 2);
  const int n = int(weights.size()) / 2;
  forRows(width, height, 8, [&](int y) {
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      for (int i = -n; i <= n; ++i) {
        const int row = y + i;
        const bool isBeyondPole = row < 0 || row >= height;
        const int inside = row < 0 ? -1 - row : row >= height ? 2 * height - 1 - row : row;
        sum +=
            weights[size_t(i + n)] * along.rgb(isBeyondPole ? (x + width / 2) % width : x, inside);
      }
      out.setRgb(x, y, sum);
    }
  });
  return out;
}

}  // namespace

LogMaps::LogMaps(const Image& latLong) : latLong_(latLong) {
  const Image small = resized(latLong, kMedianHeight);
  for (int channel = 0; channel < 3; ++channel) unit_[channel] = medianOf(small, channel);
}

Image LogMaps::map(int height) const {
  Image map = resized(latLong_, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < map.width; ++x)
      map.setRgb(x, y, glm::log(glm::max(map.rgb(x, y), 0.0f) / unit_ + kFloor));
  map = blurred(map);
  const Rgb mean(meanRadiance(map));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < map.width; ++x) map.setRgb(x, y, map.rgb(x, y) - mean);
  return map;
}

}  // namespace chromeball

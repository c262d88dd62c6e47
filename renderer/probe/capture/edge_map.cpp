// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/find_circle.h"

namespace chromeball {

Image meanLuminance(const Image& image, int scale) {
  Image small(image.width / scale, image.height / scale, 1);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      double sum = 0;
      for (int j = 0; j < scale; ++j)
        for (int i = 0; i < scale; ++i)
          sum += double(luminance(image.rgb(x * scale + i, y * scale + j)));
      *small.at(x, y) = float(sum / (scale * scale));
    }
  return small;
}

Image logarithm(Image luminance) {
  double sum = 0;
  for (const float texel : luminance.texels) sum += double(texel);
  const double floor = 1e-3 * sum / double(luminance.texels.size());
  for (float& texel : luminance.texels)
    texel = float(std::log(std::max(double(texel), std::max(floor, 1e-30))));
  return luminance;
}

double interpolate(const Image& channel, const glm::dvec2& position) {
  const glm::dvec2 corner = position - 0.5, floor = glm::floor(corner), part = corner - floor;
  const auto at = [&](int dx, int dy) {
    return double(*channel.at(std::clamp(int(floor.x) + dx, 0, channel.width - 1),
                              std::clamp(int(floor.y) + dy, 0, channel.height - 1)));
  };
  return (1 - part.y) * ((1 - part.x) * at(0, 0) + part.x * at(1, 0)) +
         part.y * ((1 - part.x) * at(0, 1) + part.x * at(1, 1));
}

EdgeMap::EdgeMap(const Image& channel, double share)
    : width(channel.width),
      height(channel.height),
      index(size_t(channel.width) * channel.height, -1) {
  // Sobel's gradient.
  std::vector<glm::dvec2> gradients(index.size());
  const auto value = [&](int x, int y) { return double(*channel.at(x, y)); };
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x)
      gradients[size_t(y) * width + x] = {
          value(x + 1, y - 1) - value(x - 1, y - 1) + 2 * (value(x + 1, y) - value(x - 1, y)) +
              value(x + 1, y + 1) - value(x - 1, y + 1),
          value(x - 1, y + 1) - value(x - 1, y - 1) + 2 * (value(x, y + 1) - value(x, y - 1)) +
              value(x + 1, y + 1) - value(x + 1, y - 1)};
  const auto length = [&](int x, int y) { return glm::length(gradients[size_t(y) * width + x]); };

  struct Candidate {
    int x, y;
    double length;
  };
  std::vector<Candidate> candidates;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      constexpr double kLeast = 0.02;  // a step of 0.5%: the operator's sum is 4 steps
      const double here = length(x, y);
      if (here < kLeast) continue;
      const glm::dvec2 along = gradients[size_t(y) * width + x] / here;
      const int dx = int(std::lround(along.x)), dy = int(std::lround(along.y));
      if (here >= length(x + dx, y + dy) && here > length(x - dx, y - dy))
        candidates.push_back({x, y, here});
    }
  const size_t most = size_t(share * double(index.size()));
  if (candidates.size() > most) {
    std::nth_element(candidates.begin(), candidates.begin() + ptrdiff_t(most), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.length > b.length; });
    candidates.resize(most);
  }
  for (const Candidate& c : candidates) {
    index[size_t(c.y) * width + c.x] = int(points.size());
    points.push_back({{c.x + 0.5, c.y + 0.5}, gradients[size_t(c.y) * width + c.x] / c.length});
  }
}

}  // namespace chromeball

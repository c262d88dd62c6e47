// SPDX-License-Identifier: Apache-2.0
#include "stone.h"

#include "base/hash.h"
#include "texels.h"

namespace chromeball::demo {

SolidTexture marble(Rgb ground, Rgb vein, float size) {
  return [=](const vec3& point) {
    const vec3 p = point / size + vec3(31, 17, 53);
    const vec3 fold(fractalNoise(p, 5), fractalNoise(p + vec3(40, 0, 0), 5),
                    fractalNoise(p + vec3(0, 40, 0), 5));
    // Veins are where a folded noise passes its mean.
    const auto veins = [&](float scale, float width) {
      const float level = fractalNoise(scale * p + 2.2f * fold, 4) - 0.5f;
      return std::exp(-std::abs(level) / width);
    };
    const float cloud = glm::smoothstep(0.3f, 0.75f, fractalNoise(0.6f * p + 3.0f * fold, 4));
    const float dark =
        std::min(1.0f, 0.9f * veins(0.8f, 0.012f) + 0.45f * veins(2.1f, 0.01f) + 0.3f * cloud);
    return glm::mix(ground, vein, dark);
  };
}

Image carve(const ImageSize& size, const Parametrisation& surface, const SolidTexture& texture) {
  return colorImage(size.width, size.height, [&](int x, int y) {
    return texture(vec3(surface((x + 0.5) / size.width, (y + 0.5) / size.height)));
  });
}

Image ashlar(int size, int columns, int rows, Rgb color) {
  Image image(size, size, 3);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float v = float(rows) * (float(y) + 0.5f) / float(size), row = std::floor(v);
      const float shift = std::fmod(row, 2.0f) * 0.5f;
      const float u = float(columns) * (float(x) + 0.5f) / float(size) + shift;
      const float column = std::fmod(std::floor(u), float(columns));
      const float tone = 0.88f + 0.24f * toUnit(uint32_t(hash(uint64_t(row), uint64_t(column), 9)));
      const float blockWidth = 1 / float(columns), blockHeight = 1 / float(rows);
      const float fromEdge = std::min(std::min(u - std::floor(u), std::ceil(u) - u) * blockWidth,
                                      std::min(v - row, row + 1 - v) * blockHeight);
      const vec3 p(7.0f * (u - std::floor(u)) * blockWidth * 6, 7.0f * (v - row) * blockHeight * 6,
                   3 * row + 11 * column);
      const float grain = 0.86f + 0.28f * fractalNoise(p, 5);
      const float joint = glm::smoothstep(0.0f, 0.0035f, fromEdge);
      image.setRgb(x, y, color * tone * grain * (0.55f + 0.45f * joint));
    }
  return image;
}

}  // namespace chromeball::demo

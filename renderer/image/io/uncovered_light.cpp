// SPDX-License-Identifier: Apache-2.0
#include "image/io/uncovered_light.h"

#include <algorithm>

#include "base/file.h"

namespace chromeball {

std::optional<Message> uncoveredLightWarning(const std::filesystem::path& path,
                                             const Image& color) {
  if (color.channels != 4 || lowerExtension(path) != ".png") return {};
  constexpr float kVisible = 1.0f / 255;
  size_t pixels = 0;
  double lost = 0, light = 0;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const Rgb rgb = color.rgb(x, y);
      const float alpha = std::clamp(color.at(x, y)[3], 0.0f, 1.0f);
      light += luminance(rgb);
      if (alpha >= 0.5f || !(maxComponent(rgb) > alpha + kVisible)) continue;
      ++pixels;
      lost += luminance(glm::max(rgb - Rgb(alpha), Rgb(0)));
    }
  if (pixels == 0) return {};
  return Message{
      Message::Kind::Warning,
      fmt::format("{}: loses light on {:.2g}% of the pixels, {:.2g}% of the image's: a "
                  ".png has no color beyond its alpha, and nothing covers the "
                  "background there; an .exr holds it",
                  path.string(), 100. * double(pixels) / (double(color.width) * color.height),
                  100 * lost / light)};
}

}  // namespace chromeball

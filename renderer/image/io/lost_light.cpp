// SPDX-License-Identifier: Apache-2.0
#include "image/io/lost_light.h"

#include <algorithm>

#include "base/file.h"

namespace chromeball {
namespace {

std::optional<Message> uncoveredLight(const std::filesystem::path& path, const Image& color) {
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

std::optional<Message> negativeLight(const std::filesystem::path& path, const Image& color) {
  const int channels = std::min(color.channels, 3);  // of colour
  size_t negative = 0;
  float least = 0;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int c = 0; c < channels; ++c)
        if (const float channel = color.at(x, y)[c]; channel < 0)
          ++negative, least = std::min(least, channel);
  if (negative == 0) return {};
  return Message{
      Message::Kind::Warning,
      fmt::format("{}: {:.3g}% of the channels are negative, down to {:.3g}, and become "
                  "0; an .exr holds them",
                  path.string(),
                  100. * double(negative) / (double(color.width) * color.height * channels),
                  least)};
}

}  // namespace

Messages lostLight(const std::filesystem::path& path, const Image& color) {
  const std::string kind = lowerExtension(path);
  Messages messages;
  const auto add = [&](std::optional<Message> message) {
    if (message) messages.push_back(*std::move(message));
  };
  if (kind == ".png" && color.channels == 4) add(uncoveredLight(path, color));
  if (kind == ".png" || kind == ".hdr") add(negativeLight(path, color));
  return messages;
}

}  // namespace chromeball

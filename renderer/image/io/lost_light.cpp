// SPDX-License-Identifier: Apache-2.0
#include "image/io/lost_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/file.h"
#include "image/io/radiance_hdr.h"

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

// What a format cannot hold of the numbers of the colour's channels.
struct NumbersBeyond {
  size_t negative = 0, tooLarge = 0, invalid = 0, count = 0;
  float least = 0, largest = 0;

  NumbersBeyond(const Image& color, float limit) {
    const int channels = std::min(color.channels, 3);
    count = size_t(color.width) * size_t(color.height) * size_t(channels);
    for (int y = 0; y < color.height; ++y)
      for (int x = 0; x < color.width; ++x)
        for (int c = 0; c < channels; ++c) add(color.at(x, y)[c], limit);
  }
  double percent(size_t numbers) const { return 100. * double(numbers) / double(count); }

 private:
  void add(float number, float limit) {
    if (number < 0) ++negative, least = std::min(least, number);
    if (number > limit) ++tooLarge, largest = std::max(largest, number);
    if (!std::isfinite(number)) ++invalid;
  }
};

// Of a .png what is above white is clipped as any bright surface is.
Messages numbersLost(const std::filesystem::path& path, const Image& color, bool isHdr) {
  const NumbersBeyond beyond(color, isHdr ? kMaxRgbe : std::numeric_limits<float>::infinity());
  Messages messages;
  const auto add = [&](size_t numbers, const std::string& what) {
    if (numbers > 0)
      messages.push_back({Message::Kind::Warning,
                          fmt::format("{}: {:.3g}% of the channels are {}; an .exr holds them",
                                      path.string(), beyond.percent(numbers), what)});
  };
  add(beyond.negative, fmt::format("negative, down to {:.3g}, and become 0", beyond.least));
  if (!isHdr) return messages;
  add(beyond.tooLarge,
      fmt::format("above {:.3g}, up to {:.3g}, and are cut", kMaxRgbe, beyond.largest));
  add(beyond.invalid, "NaN or infinite, and become 0");
  return messages;
}

}  // namespace

Messages lostLight(const std::filesystem::path& path, const Image& color) {
  const std::string kind = lowerExtension(path);
  Messages messages;
  if (kind == ".png" && color.channels == 4)
    if (std::optional<Message> message = uncoveredLight(path, color))
      messages.push_back(*std::move(message));
  if (kind == ".png" || kind == ".hdr")
    for (Message& message : numbersLost(path, color, kind == ".hdr"))
      messages.push_back(std::move(message));
  return messages;
}

}  // namespace chromeball

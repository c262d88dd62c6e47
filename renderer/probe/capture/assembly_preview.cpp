// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/assembly_preview.h"

#include "probe/preview.h"

namespace chromeball {
namespace {

constexpr int kWidth = 1024, kTile = 320;
const Rgb kCircle(1, 0.02f, 0.02f), kStripe(1, 0, 0.6f);

// Mean of the part of an image that a pixel of a smaller (or larger) copy covers.
Rgb meanOver(const Image& image, double left, double top, double right, double bottom) {
  const int x0 = std::clamp(int(left), 0, image.width - 1);
  const int y0 = std::clamp(int(top), 0, image.height - 1);
  const int x1 = std::clamp(int(std::ceil(right)), x0 + 1, image.width);
  const int y1 = std::clamp(int(std::ceil(bottom)), y0 + 1, image.height);
  dvec3 sum(0);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      sum += image.channels == 1 ? dvec3(*image.at(x, y)) : dvec3(image.rgb(x, y));
  return Rgb(sum / (double(x1 - x0) * (y1 - y0)));
}

Image tile(const PhotographPreview& photograph, const DisplayTransform& transform) {
  const Image& image = *photograph.image;
  const double scale = double(std::max(image.width, image.height)) / kTile;
  Image out(std::max(1, int(image.width / scale)), std::max(1, int(image.height / scale)), 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto mean = [&](const Image& of) {
        return meanOver(of, x * scale, y * scale, (x + 1) * scale, (y + 1) * scale);
      };
      Rgb color = display(transform, float(photograph.gain) * mean(image));
      if (!photograph.mask->empty()) color *= 0.25f + 0.75f * mean(*photograph.mask);
      const dvec2 fromCentre = scale * dvec2(x + 0.5, y + 0.5) - photograph.circle.centre;
      const bool isOnCircle =
          std::fabs(glm::length(fromCentre) - photograph.circle.radius) < 0.75 * scale;
      out.setRgb(x, y, isOnCircle ? kCircle : color);
    }
  return out;
}

Image mapOf(const Assembly& assembly, const DisplayTransform& transform) {
  constexpr int kPeriod = 12;
  const double scale = std::max(1.0, double(assembly.latLong.width) / kWidth);
  Image out(int(assembly.latLong.width / scale), int(assembly.latLong.height / scale), 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto mean = [&](const Image& of) {
        return meanOver(of, x * scale, y * scale, (x + 1) * scale, (y + 1) * scale);
      };
      const bool isStripe = (x + y) % kPeriod < kPeriod / 3;
      const bool isBlind = mean(assembly.coverage).x < 0.5f;
      out.setRgb(x, y, isBlind && isStripe ? kStripe : display(transform, mean(assembly.latLong)));
    }
  return out;
}

void paste(const Image& from, Image& to, int left, int top) {
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) to.setRgb(left + x, top + y, from.rgb(x, y));
}

}  // namespace

Image assemblyPreview(const std::vector<PhotographPreview>& photographs, const Assembly& assembly) {
  const DisplayTransform transform = previewTransform(assembly.latLong);
  std::vector<Image> tiles;
  for (const PhotographPreview& photograph : photographs)
    tiles.push_back(tile(photograph, transform));
  const Image map = mapOf(assembly, transform);

  constexpr int kPerRow = kWidth / kTile;
  const int rows = (int(tiles.size()) + kPerRow - 1) / kPerRow;
  const int width = std::max(map.width, kTile * std::min(int(tiles.size()), kPerRow));
  Image out(width, rows * kTile + map.height, 3);
  for (int i = 0; i < int(tiles.size()); ++i)
    paste(tiles[size_t(i)], out, i % kPerRow * kTile, i / kPerRow * kTile);
  paste(map, out, 0, rows * kTile);
  return out;
}

}  // namespace chromeball

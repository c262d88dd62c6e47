// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/assembly_preview.h"

#include "image/image.h"
#include "probe/preview.h"

namespace chromeball {
namespace {

constexpr int kWidth = 1024, kTile = 320;
const Rgb kCircle(1, 0.02f, 0.02f), kStripe(1, 0, 0.6f);

// The largest copy of at most so many pixels along the longer side.
Image reduced(const Image& image, int longest) {
  const double scale = double(longest) / std::max(image.width, image.height);
  return resampled(image, std::max(1, int(image.width * scale)),
                   std::max(1, int(image.height * scale)));
}

Image tile(const PhotographPreview& photograph, const DisplayTransform& transform) {
  const Image small = reduced(*photograph.image, kTile);
  const bool hasMask = !photograph.mask->empty();
  const Image mask = hasMask ? reduced(*photograph.mask, kTile) : Image();
  const double scale = double(photograph.image->width) / small.width;
  Image out(small.width, small.height, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      Rgb color = display(transform, float(photograph.gain) * small.rgb(x, y));
      if (hasMask) color *= 0.25f + 0.75f * *mask.at(x, y);
      const dvec2 fromCentre = scale * dvec2(x + 0.5, y + 0.5) - photograph.circle.centre;
      const bool isOnCircle =
          std::fabs(glm::length(fromCentre) - photograph.circle.radius) < 0.75 * scale;
      out.setRgb(x, y, isOnCircle ? kCircle : color);
    }
  return out;
}

Image mapOf(const Assembly& assembly, const DisplayTransform& transform) {
  constexpr int kPeriod = 12;
  const int longest = std::min(assembly.latLong.width, kWidth);
  const Image map = reduced(assembly.latLong, longest);
  const Image coverage = reduced(assembly.coverage, longest);
  Image out(map.width, map.height, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const bool isStripe = (x + y) % kPeriod < kPeriod / 3;
      const bool isBlind = *coverage.at(x, y) < 0.5f;
      out.setRgb(x, y, isBlind && isStripe ? kStripe : display(transform, map.rgb(x, y)));
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

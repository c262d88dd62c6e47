// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/assemble.h"

#include "base/parallel.h"
#include "image/image.h"
#include "probe/convert.h"
#include "probe/probe.h"

namespace chromeball {

Assembly assemble(const std::vector<CaptureView>& views, const ImageSize& size) {
  double pixels = 0;
  for (const CaptureView& view : views) pixels = std::max(pixels, view.pixelsOfSphere());
  const double perTexel = pixels / (double(size.width) * size.height);
  const int samples = std::max(2, int(std::ceil(2 * std::sqrt(perTexel))));

  Assembly assembly{Image(size.width, size.height, 3), Image(size.width, size.height, 1)};
  std::vector<double> blind(size_t(size.height));  // solid angle by row
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      dvec3 sum(0);
      double shown = 0, all = 0;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const dvec2 uv((x + (i + 0.5) / samples) / size.width,
                         (y + (j + 0.5) / samples) / size.height);
          const double w = std::sin(kPiD * uv.y);
          all += w;
          const CaptureView::Sample sample = merged(views, *uvToDirection(Mapping::LatLong, uv));
          if (sample.weight == 0) continue;
          shown += w;
          sum += w * sample.radiance;
        }
      if (shown > 0) assembly.latLong.setRgb(x, y, Rgb(sum / shown));
      *assembly.coverage.at(x, y) = float(shown / all);
      blind[size_t(y)] += (1 - shown / all) * texelSolidAngle(y, size.width, size.height);
    }
  });
  for (const double solidAngle : blind) assembly.blindShare += solidAngle / (4 * kPiD);
  return assembly;
}

ImageSize assemblySize(const std::vector<CaptureView>& views) {
  constexpr double kMostRows = 8192;
  double pixels = 1;
  for (const CaptureView& view : views) pixels = std::max(pixels, view.pixelsOfSphere());
  // A pixel covers 4 pi / pixels, a texel at the horizon (pi / rows)^2.
  const double rows = std::min(0.5 * std::sqrt(kPiD * pixels), kMostRows);
  const int even = std::max(2, 2 * int(std::ceil(0.5 * rows - 1e-9)));
  return {2 * even, even};
}

void fillBlind(const BlindFill& fill, Assembly& assembly) {
  if (fill.isSmooth) return inpaintBlind(assembly);
  const std::optional<Probe> probe = fill.map ? std::optional<Probe>(*fill.map) : std::nullopt;
  const ImageSize size{assembly.latLong.width, assembly.latLong.height};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (*assembly.coverage.at(x, y) == 0)
        assembly.latLong.setRgb(
            x, y, probe ? probe->radiance(vec3(texelDirection(size, x, y))) : fill.color);
}

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
  return colorImage(small.width, small.height, [&](int x, int y) {
    Rgb color = display(transform, float(photograph.gain) * small.rgb(x, y));
    if (hasMask) color *= 0.25f + 0.75f * *mask.at(x, y);
    const dvec2 fromCentre = scale * dvec2(x + 0.5, y + 0.5) - photograph.circle.centre;
    const bool isOnCircle =
        std::fabs(glm::length(fromCentre) - photograph.circle.radius) < 0.75 * scale;
    return isOnCircle ? kCircle : color;
  });
}

Image mapOf(const Assembly& assembly, const DisplayTransform& transform) {
  constexpr int kPeriod = 12;
  const int longest = std::min(assembly.latLong.width, kWidth);
  const Image map = reduced(assembly.latLong, longest);
  const Image coverage = reduced(assembly.coverage, longest);
  return colorImage(map.width, map.height, [&](int x, int y) {
    const bool isStripe = (x + y) % kPeriod < kPeriod / 3;
    const bool isBlind = *coverage.at(x, y) < 0.5f;
    return isBlind && isStripe ? kStripe : display(transform, map.rgb(x, y));
  });
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

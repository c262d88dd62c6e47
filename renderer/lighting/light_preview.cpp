// SPDX-License-Identifier: Apache-2.0
#include "lighting/light_preview.h"

#include "probe/preview.h"

namespace chromeball {
namespace {

constexpr int kWidth = 1024, kHeight = 512;

// Sizes in pixels.
struct Dot {
  Rgb color;
  double radius, rim;
};

// A dot with a black rim; it wraps at the seam.
void drawDot(Image& image, dvec2 uv, const Dot& dot) {
  const dvec2 centre = uv * dvec2(kWidth, kHeight);
  for (int y = int(centre.y - dot.rim); y <= int(centre.y + dot.rim); ++y)
    for (int x = int(centre.x - dot.rim - 1); x <= int(centre.x + dot.rim); ++x) {
      const double distance = glm::distance(centre, dvec2(x + 0.5, y + 0.5));
      if (y < 0 || y >= kHeight || distance > dot.rim) continue;
      image.setRgb((x + kWidth) % kWidth, y, distance < dot.radius ? dot.color : Rgb(0));
    }
}

void drawDots(Image& image, const Constellation& lights, const Dot& dot) {
  for (const DirectionalLight& light : lights)
    drawDot(image, directionToUv(Mapping::LatLong, dvec3(light.direction)), dot);
}

// Pixels of lines, row by row.
using Lines = std::vector<bool>;

// Adds the pixels whose right or lower neighbour is in another region.
void addOutlines(Lines& lines, const Image& latLong, const Partition& partition) {
  const auto region = [&](int x, int y) {
    const int64_t column = int64_t(x % kWidth) * latLong.width / kWidth;
    const int64_t row = int64_t(std::min(y, kHeight - 1)) * latLong.height / kHeight;
    return partition.label[size_t(row) * latLong.width + size_t(column)];
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (region(x, y) != region(x + 1, y) || region(x, y) != region(x, y + 1))
        lines[size_t(y) * kWidth + size_t(x)] = true;
}

// Where the line is inside the image.
void addLine(Lines& lines, const MapLine& line) {
  const dvec2 size(kWidth, kHeight), from = line.from * size, to = line.to * size;
  const dvec2 length = abs(to - from);
  const int steps = int(std::max(length.x, length.y)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const dvec2 p = floor(mix(from, to, double(i) / steps));
    if (p.x >= 0 && p.x < kWidth && p.y >= 0 && p.y < kHeight)
      lines[size_t(p.y) * kWidth + size_t(p.x)] = true;
  }
}

// White with a black edge, as they pass over bright and dark parts of the map.
void drawLines(Image& image, const Lines& lines) {
  const auto isLine = [&](int x, int y) {
    return y >= 0 && y < kHeight && lines[size_t(y) * kWidth + size_t((x + kWidth) % kWidth)];
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (isLine(x, y))
        image.setRgb(x, y, Rgb(1));
      else if (isLine(x - 1, y) || isLine(x + 1, y) || isLine(x, y - 1) || isLine(x, y + 1))
        image.setRgb(x, y, Rgb(0));
}

}  // namespace

Image lightPreview(const Image& latLong, const Constellation& lights) {
  Image preview = probePreview(Probe(latLong), kWidth);
  drawDots(preview, lights, {Rgb(1), 3, 5});
  return preview;
}

Image lightPreview(const Image& latLong, const Constellation& lights, const LightRegions& regions) {
  Image preview = probePreview(Probe(latLong), kWidth);
  Lines lines(size_t(kWidth) * kHeight, false);
  if (regions.partition.regions > 0) addOutlines(lines, latLong, regions.partition);
  for (const MapLine& line : regions.tiling) addLine(lines, line);
  drawLines(preview, lines);
  drawDots(preview, lights, {Rgb(1, 0, 0), 2.5, 3.5});
  return preview;
}

}  // namespace chromeball

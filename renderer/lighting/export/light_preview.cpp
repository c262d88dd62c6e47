// SPDX-License-Identifier: Apache-2.0
#include "lighting/export/light_preview.h"

#include "base/parallel.h"
#include "image/tonemap.h"
#include "math/icosphere.h"
#include "probe/convert.h"

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

// Adds the parts of the line that are inside the image.
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

namespace {

constexpr int kDiameter = 300, kGap = 20, kStep = kDiameter + kGap, kSwatch = 80;  // pixels
constexpr int kSubpixels = 4;                                                      // along a side
constexpr float kBackground = 0.015f;

constexpr int kSubpixelRow = kDiameter * kSubpixels;

// The face under each subpixel of a disc, row by row, seen from +Z (side 1) or -Z (-1); -1 outside.
std::vector<int> facesOf(float side, int subdivisions) {
  std::vector<int> faces(size_t(kSubpixelRow) * kSubpixelRow, -1);
  parallelFor(0, kSubpixelRow, [&](int y) {
    for (int x = 0; x < kSubpixelRow; ++x) {
      const vec2 p = (vec2(x, y) + 0.5f) * (2.0f / kSubpixelRow) - 1.0f;
      const float height = 1 - dot(p, p);
      if (height > 0)
        faces[size_t(y) * kSubpixelRow + size_t(x)] =
            icosphereFace({side * p.x, -p.y, side * std::sqrt(height)}, subdivisions);
    }
  });
  return faces;
}

void drawDisc(Image& picture, int left, int top, const std::vector<int>& faces,
              const std::vector<Rgb>& colors) {
  parallelFor(0, kDiameter, [&](int y) {
    for (int x = 0; x < kDiameter; ++x) {
      Rgb sum(0);
      for (int j = kSubpixels * y; j < kSubpixels * (y + 1); ++j)
        for (int i = kSubpixels * x; i < kSubpixels * (x + 1); ++i) {
          const int face = faces[size_t(j) * kSubpixelRow + size_t(i)];
          sum += face < 0 ? Rgb(kBackground) : colors[size_t(face)];
        }
      picture.setRgb(left + x, top + y, sum / float(kSubpixels * kSubpixels));
    }
  });
}

double largest(const std::vector<dvec3>& numbers) {
  double most = 0;
  for (const dvec3& n : numbers) most = std::max({most, n.x, n.y, n.z});
  return most;
}

std::vector<dvec3> differenceOf(const IrradianceSpheres& spheres) {
  std::vector<dvec3> difference;
  for (size_t i = 0; i < spheres.lights.size(); ++i)
    difference.push_back(spheres.lights[i] - spheres.probe[i]);
  return difference;
}

// Radiance is irradiance / pi, so that this is the exposure over pi.
double exposureOf(const IrradianceSpheres& spheres) {
  const double brightest = std::max(largest(spheres.probe), largest(spheres.lights));
  return brightest > 0 ? 1 / brightest : 0;
}

std::vector<Rgb> colorsOf(const std::vector<dvec3>& irradiances, double factor) {
  std::vector<Rgb> colors;
  for (const dvec3& e : irradiances) colors.emplace_back(factor * e);
  return colors;
}

Rgb signedColor(const Rgb& difference) {
  Rgb color;
  for (int c = 0; c < 3; ++c)
    color[c] = srgbToLinear(0.5f + 0.5f * linearToSrgb(std::clamp(difference[c], -1.0f, 1.0f)));
  return color;
}

}  // namespace

double differenceGain(const IrradianceSpheres& spheres) {
  double most = 0;
  for (const dvec3& d : differenceOf(spheres))
    most = std::max({most, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
  most *= exposureOf(spheres);
  constexpr double kMost = 1024;
  return most > 0 ? std::min(std::exp2(std::floor(-std::log2(most))), kMost) : 1;
}

Image irradianceSpheres(const IrradianceSpheres& spheres) {
  const double factor = exposureOf(spheres);
  std::vector<Rgb> differences = colorsOf(differenceOf(spheres), factor * differenceGain(spheres));
  for (Rgb& difference : differences) difference = signedColor(difference);
  const std::vector<Rgb> discs[] = {colorsOf(spheres.probe, factor),
                                    colorsOf(spheres.lights, factor), std::move(differences)};

  const int width = 3 * kStep + kGap, height = 2 * kStep + kGap;
  Image picture(width + (spheres.ambient ? kSwatch + kGap : 0), height, 3);
  std::fill(picture.texels.begin(), picture.texels.end(), kBackground);
  for (const int row : {0, 1}) {
    const std::vector<int> faces = facesOf(row == 0 ? 1.0f : -1.0f, spheres.subdivisions);
    for (const int column : {0, 1, 2})
      drawDisc(picture, kGap + column * kStep, kGap + row * kStep, faces, discs[column]);
  }
  if (spheres.ambient) {
    const Rgb color(dvec3(*spheres.ambient) * (kPiD * factor));
    for (int y = (height - kSwatch) / 2; y < (height + kSwatch) / 2; ++y)
      for (int x = width; x < width + kSwatch; ++x) picture.setRgb(x, y, color);
  }
  return picture;
}

}  // namespace chromeball

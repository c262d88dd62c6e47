// SPDX-License-Identifier: Apache-2.0
#include "lighting/irradiance_spheres.h"

#include <algorithm>

#include "base/parallel.h"
#include "image/tonemap.h"
#include "math/icosphere.h"

namespace chromeball {
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

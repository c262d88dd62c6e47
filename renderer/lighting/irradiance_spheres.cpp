// SPDX-License-Identifier: Apache-2.0
#include "lighting/irradiance_spheres.h"

#include <algorithm>
#include <functional>

#include "image/tonemap.h"
#include "math/icosphere.h"

namespace chromeball {
namespace {

constexpr int kDiameter = 300, kGap = 20, kStep = kDiameter + kGap, kSwatch = 80;  // pixels
constexpr int kSubpixels = 4;                                                      // along a side
constexpr float kBackground = 0.015f;

// Draws a disc in column `column` and row `row`, whose pixels have the colour of their face.
void drawDisc(Image& picture, int column, int row, const IrradianceSpheres& spheres,
              const std::function<Rgb(int face)>& color) {
  const int left = kGap + column * kStep, top = kGap + row * kStep;
  const float side = row == 0 ? 1.0f : -1.0f;  // which of the sphere's sides is seen: +Z or -Z
  for (int y = 0; y < kDiameter; ++y)
    for (int x = 0; x < kDiameter; ++x) {
      Rgb sum(0);
      for (int i = 0; i < kSubpixels * kSubpixels; ++i) {
        const vec2 offset((i % kSubpixels + 0.5f) / kSubpixels,
                          (i / kSubpixels + 0.5f) / kSubpixels);
        const vec2 p = (vec2(x, y) + offset) * (2.0f / kDiameter) - 1.0f;
        const float height = 1 - dot(p, p);
        sum += height <= 0 ? Rgb(kBackground)
                           : color(icosphereFace({side * p.x, -p.y, side * std::sqrt(height)},
                                                 spheres.subdivisions));
      }
      picture.setRgb(left + x, top + y, sum / float(kSubpixels * kSubpixels));
    }
}

Rgb signedColor(const Rgb& difference) {
  Rgb color;
  for (int c = 0; c < 3; ++c)
    color[c] = srgbToLinear(0.5f + 0.5f * linearToSrgb(std::clamp(difference[c], -1.0f, 1.0f)));
  return color;
}

}  // namespace

Image irradianceSpheres(const IrradianceSpheres& spheres) {
  double brightest = 0;
  for (const auto* irradiances : {&spheres.probe, &spheres.lights})
    for (const dvec3& e : *irradiances) brightest = std::max({brightest, e.x, e.y, e.z});
  // Radiance is irradiance / pi, so that this factor is the exposure over pi.
  const double factor = brightest > 0 ? 1 / brightest : 0;
  const auto probe = [&](int face) { return Rgb(factor * spheres.probe[face]); };
  const auto lights = [&](int face) { return Rgb(factor * spheres.lights[face]); };
  const auto difference = [&](int face) {
    return signedColor(Rgb(factor * (spheres.lights[face] - spheres.probe[face])));
  };

  const int width = 3 * kStep + kGap, height = 2 * kStep + kGap;
  Image picture(width + (spheres.ambient ? kSwatch + kGap : 0), height, 3);
  std::fill(picture.texels.begin(), picture.texels.end(), kBackground);
  for (const int row : {0, 1}) {
    drawDisc(picture, 0, row, spheres, probe);
    drawDisc(picture, 1, row, spheres, lights);
    drawDisc(picture, 2, row, spheres, difference);
  }
  if (spheres.ambient) {
    const Rgb color(dvec3(*spheres.ambient) * (kPiD * factor));
    for (int y = (height - kSwatch) / 2; y < (height + kSwatch) / 2; ++y)
      for (int x = width; x < width + kSwatch; ++x) picture.setRgb(x, y, color);
  }
  return picture;
}

}  // namespace chromeball

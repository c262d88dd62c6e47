// SPDX-License-Identifier: Apache-2.0
#include "probe/edit.h"

namespace chromeball {
namespace {

bool isBelowHorizon(int row, const Image& latLong) { return 2 * row >= latLong.height; }

}  // namespace

void replaceBelowHorizon(Image& latLong, const Rgb& radiance) {
  for (int y = 0; y < latLong.height; ++y) {
    const bool isHalfBelow = 2 * y + 1 == latLong.height;
    for (int x = 0; x < latLong.width; ++x)
      if (isHalfBelow)
        latLong.setRgb(x, y, 0.5f * latLong.rgb(x, y) + 0.5f * radiance);
      else if (isBelowHorizon(y, latLong))
        latLong.setRgb(x, y, radiance);
  }
}

void mirrorAtHorizon(Image& latLong) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; isBelowHorizon(y, latLong) && x < latLong.width; ++x)
      latLong.setRgb(x, y, latLong.rgb(x, latLong.height - 1 - y));
}

void mirrorLeftAndRight(Image& latLong) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; 2 * x < latLong.width - 1; ++x) {
      const int opposite = latLong.width - 1 - x;
      const Rgb left = latLong.rgb(x, y);
      latLong.setRgb(x, y, latLong.rgb(opposite, y));
      latLong.setRgb(opposite, y, left);
    }
}

size_t multiplyRegion(Image& latLong, const dvec3& centre, double radius, const Rgb& gain) {
  const double cosRadius = std::cos(radius * kPiD / 180);
  size_t count = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      if (glm::dot(texelDirection({latLong.width, latLong.height}, x, y), centre) >= cosRadius) {
        latLong.setRgb(x, y, latLong.rgb(x, y) * gain);
        ++count;
      }
  return count;
}

void multiply(Image& latLong, const Rgb& scale) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) latLong.setRgb(x, y, latLong.rgb(x, y) * scale);
}

void clip(Image& latLong, float limit) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      latLong.setRgb(x, y, glm::min(latLong.rgb(x, y), Rgb(limit)));
}

}  // namespace chromeball

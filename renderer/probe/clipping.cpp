// SPDX-License-Identifier: Apache-2.0
#include "probe/clipping.h"

#include <array>
#include <bit>
#include <limits>

#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// Calls visit(radiance, solid angle) for all texels.
template <class Visit>
void forTexels(const Image& latLong, const Visit& visit) {
  for (int y = 0; y < latLong.height; ++y) {
    const double solidAngle = texelSolidAngle(y, latLong.width, latLong.height);
    for (int x = 0; x < latLong.width; ++x) visit(latLong.rgb(x, y), solidAngle);
  }
}

}  // namespace

Plateau plateau(const Image& latLong) {
  constexpr size_t kMinTexels = 8;
  constexpr double kMinSolidAngle = 1.36e-4, kMaxSolidAngle = 0.9 * 4 * kPiD;
  float maximum = 0;
  forTexels(latLong, [&](const Rgb& c, double) { maximum = std::max(maximum, maxComponent(c)); });
  Plateau found;
  size_t shoulder = 0;
  forTexels(latLong, [&](const Rgb& c, double solidAngle) {
    if (maxComponent(c) >= 0.998f * maximum) {
      ++found.texels;
      found.solidAngle += solidAngle;
    } else if (maxComponent(c) >= 0.99f * maximum) {
      ++shoulder;
    }
  });
  found.looksClipped = maximum > 0 && found.texels >= kMinTexels && shoulder < found.texels &&
                       found.solidAngle >= kMinSolidAngle && found.solidAngle <= kMaxSolidAngle;
  return found;
}

double robustRange(const Image& latLong) {
  constexpr double kTail = 0.01;
  // A histogram by the upper half of a float's bits: 128 bins for each factor of two.
  std::array<double, 0x8000> solidAngles{};
  forTexels(latLong, [&](const Rgb& c, double solidAngle) {
    solidAngles[std::bit_cast<uint32_t>(std::max(luminance(c), 0.0f)) >> 16] += solidAngle;
  });
  const auto percentile = [&](double fraction) {
    double below = 0;
    size_t bin = 0;
    while (bin + 1 < solidAngles.size() && (below += solidAngles[bin]) <= fraction * 4 * kPiD)
      ++bin;
    return double(std::bit_cast<float>(uint32_t(bin) << 16));
  };
  const double low = percentile(kTail), high = percentile(1 - kTail);
  if (high == 0) return 0;
  return low > 0 ? high / low : std::numeric_limits<double>::infinity();
}

double lostIfClippedAtWhite(const Image& latLong) {
  constexpr double kMean = 0.18;
  const double mean = luminance(meanRadiance(latLong)), white = mean / kMean;
  double all = 0, lost = 0;
  forTexels(latLong, [&](const Rgb& c, double solidAngle) {
    const glm::dvec3 radiance(c);
    all += solidAngle * (radiance.x + radiance.y + radiance.z);
    for (int i = 0; i < 3; ++i) lost += solidAngle * std::max(radiance[i] - white, 0.0);
  });
  return all > 0 ? lost / all : 0;
}

}  // namespace chromeball

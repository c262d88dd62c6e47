// SPDX-License-Identifier: Apache-2.0
#include "probe/prefiltered_probe.h"

#include <algorithm>
#include <bit>

#include "probe/convolve.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

constexpr double kError = 2e-2;  // of the convolution
constexpr ImageSize kDiffuseSize{128, 64};
constexpr int kMaxWidth = 256;

// Texels of a quarter of the lobe's width: 2 alpha, as seen by the mirror direction.
ImageSize sizeFor(float roughness) {
  const double wanted = 4 * kPiD / (double(roughness) * roughness);
  const int width = wanted < kMaxWidth ? int(std::bit_ceil(unsigned(wanted))) : kMaxWidth;
  return {width, width / 2};
}

Probe filtered(const Image& map, const Rotation& rotation, const ZonalKernel& kernel,
               const ImageSize& size) {
  return Probe(imageOf(size, convolve(map, kernel, texelDirections(size), kError)), rotation);
}

}  // namespace

PrefilteredProbe::PrefilteredProbe(const Probe& probe, std::vector<float> roughnesses)
    : probe_(probe),
      diffuse_(filtered(probe.latLong(), probe.rotation(), ZonalKernel::phong(1), kDiffuseSize)) {
  std::ranges::sort(roughnesses);
  const Image map = probe.latLong();
  for (const float roughness : roughnesses)
    levels_.push_back({roughness, filtered(map, probe.rotation(), ZonalKernel::ggx(roughness),
                                           sizeFor(roughness))});
}

Rgb PrefilteredProbe::radiance(const vec3& direction, float roughness) const {
  size_t above = 0;
  while (above < levels_.size() && levels_[above].roughness < roughness) ++above;
  const bool isLast = above == levels_.size();
  const float from = above == 0 ? 0 : levels_[above - 1].roughness;
  const float to = isLast ? 1 : levels_[above].roughness;
  const float t = (roughness - from) / (to - from);
  Rgb sum(0);
  if (t < 1) sum += (1 - t) * (above == 0 ? probe_ : levels_[above - 1].map).radiance(direction);
  if (t > 0) sum += t * (isLast ? diffuse_ : levels_[above].map).radiance(direction);
  return sum;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What paths in lanes share.
#pragma once

#include <bit>

#include "math/lanes.h"
#include "transport/path_settings.h"

namespace chromeball {

inline constexpr size_t kLanes = LanesOf<Float8>::kCount;

// As misWeight(), bsdfSampleWeight() and lightSampleWeight().
inline Float8 misWeight(Mis mis, Float8 own, Float8 other) {
  const Float8 ratio = other / own;
  return 1 / (1 + (mis == Mis::Power ? ratio * ratio : ratio));
}
inline Float8 weightOfBsdfSample(Mis mis, Float8 bsdfPdf, Float8 lightPdf) {
  const Float8 both = mis == Mis::Off ? Float8{} : misWeight(mis, bsdfPdf, lightPdf);
  return lightPdf == 0 ? LanesOf<Float8>::splat(1) : both;
}
inline Float8 weightOfLightSample(Mis mis, Float8 lightPdf, Float8 bsdfPdf) {
  return mis == Mis::Off ? LanesOf<Float8>::splat(1) : misWeight(mis, lightPdf, bsdfPdf);
}

// Calls visit(lane) for the bits that are set.
template <class Visit>
void forBits(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(unsigned(std::countr_zero(bits)));
}

inline Int8 isBlack(const Lanes3<Float8>& c) { return (c.x == 0) & (c.y == 0) & (c.z == 0); }

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "integrate/guiding/caustic_guide.h"

#include <algorithm>

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr size_t kMinPhotons = 500;        // of a region that is the half of another
constexpr size_t kMinPhotonsToGuide = 20;  // of a region with lobes

}  // namespace

CausticGuide::CausticGuide(std::vector<Photon> photons) {
  std::vector<std::span<Photon>> regions;
  tree_ = RegionTree(std::span(photons), kMinPhotons, regions);
  regions_.assign(regions.size(), {});
  parallelFor(size_t(0), regions.size(), [&](size_t i) {
    if (regions[i].size() >= kMinPhotonsToGuide) regions_[i] = CausticLobes(regions[i]);
  });
  if (std::all_of(regions_.begin(), regions_.end(), [](const auto& r) { return r.empty(); }))
    *this = CausticGuide();
}

}  // namespace chromeball

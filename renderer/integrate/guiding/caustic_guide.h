// SPDX-License-Identifier: Apache-2.0
// Guided bounces: directions from which mirrors, metals and glass throw the probe's light onto
// rough surfaces, learned from photons. No light sample finds such light, and bounces find it by
// chance.
#pragma once

#include <span>
#include <vector>

#include "integrate/guiding/caustic_lobes.h"
#include "integrate/guiding/region_tree.h"

namespace chromeball {

// Light that was found behind a bounce where the guide has lobes.
struct BounceRecord {
  float found;              // |luminance| of what the path added to its pixel's sample
  float lobesPdf, bsdfPdf;  // of the bounce
  float fraction;           // of such bounces that came from the lobes
};

class CausticGuide {
 public:
  CausticGuide() = default;
  explicit CausticGuide(std::vector<Photon> photons);

  // Whether nothing is guided: find() returns null everywhere.
  bool empty() const { return tree_.empty(); }
  // Null where there are no caustics.
  const CausticLobes* find(const vec3& position, const vec3& normal) const {
    if (empty()) return nullptr;
    const CausticLobes& region = regions_[tree_.find(position, normal)];
    return region.empty() ? nullptr : &region;
  }

  // Of the bounces in regions with lobes, those whose direction comes from the lobes.
  float fraction() const { return fraction_; }
  static constexpr float kTrainingFraction = 0.25f;
  void setFraction(float fraction) { fraction_ = fraction; }

  void archive(Archive& a) {
    a(regions_);
    tree_.archive(a, regions_.size());
    a(fraction_);
    a.check(fraction_ >= 0 && fraction_ < 1);
  }

 private:
  RegionTree tree_;
  std::vector<CausticLobes> regions_;
  float fraction_ = kTrainingFraction;
};

}  // namespace chromeball

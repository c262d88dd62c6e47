// SPDX-License-Identifier: Apache-2.0
#include "guiding/light_guide.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr size_t kMinRecords = 1000;  // of a region that is the half of another
constexpr size_t kMinToGuide = 100;   // fewer leave light that none of them found to fireflies
constexpr std::array kFractions = {1.0f, 0.5f, 0.25f, 0.1f, 0.02f};  // of the strategy's samples
// A guided light sample takes up to twice the time.
constexpr double kMaxMomentRatio = 0.7;

using Records = std::span<const LightRecord>;

// Of every `step`-th record, beginning with the first.
DirectionTree treeOf(Records records, size_t step) {
  std::vector<DirectionTree::Point> points;
  points.reserve(records.size() / step + 1);
  for (size_t i = 0; i < records.size(); i += step)
    points.push_back(
        {uniformSphereToSquare(records[i].direction), records[i].integrand / records[i].density});
  return DirectionTree(points);
}

// Adds, for each fraction, the part of every second record in the second moment of
//   f cos L / (pdf of light samples + pdf of BSDF samples).
void addMoments(Records records, const DirectionTree& tree,
                std::array<double, kFractions.size()>& moments) {
  for (size_t k = 0; k < records.size(); k += 2) {
    const LightRecord& r = records[k];
    const float treePdf = tree.pdf(r.direction);
    const double squared = double(r.integrand) * r.integrand / r.density;
    for (size_t i = 0; i < kFractions.size(); ++i)
      moments[i] +=
          squared / (kFractions[i] * r.strategyPdf + (1 - kFractions[i]) * treePdf + r.bsdfPdf);
  }
}

}  // namespace

// Each half of the records judges the tree of the other half: a tree seems better than it is on
// the records that it was made of.
GuideRegion::GuideRegion(std::span<const LightRecord> records) {
  if (records.size() < kMinToGuide) return;
  std::array<double, kFractions.size()> moments{};
  addMoments(records, treeOf(records.subspan(1), 2), moments);
  addMoments(records.subspan(1), treeOf(records, 2), moments);
  const size_t best = size_t(std::min_element(moments.begin(), moments.end()) - moments.begin());
  moments_ = {moments[0], moments[0]};
  if (!(moments[best] < kMaxMomentRatio * moments[0])) return;
  moments_.with = moments[best];
  strategyFraction_ = kFractions[best];
  tree_ = treeOf(records, 1);
}

void LightGuide::learn(std::vector<LightRecord> records) {
  std::vector<std::span<LightRecord>> regions;
  tree_ = RegionTree(std::span(records), kMinRecords, regions);
  regions_.assign(regions.size(), {});
  parallelFor(size_t(0), regions.size(), [&](size_t i) { regions_[i] = GuideRegion(regions[i]); });
}

size_t LightGuide::guidedRegions() const {
  return size_t(std::count_if(regions_.begin(), regions_.end(),
                              [](const GuideRegion& r) { return r.isGuided(); }));
}

GuideRegion::Moments LightGuide::moments() const {
  GuideRegion::Moments sum;
  for (const GuideRegion& r : regions_) {
    sum.without += r.moments().without;
    sum.with += r.moments().with;
  }
  return sum;
}

}  // namespace chromeball

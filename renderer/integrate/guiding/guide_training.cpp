// SPDX-License-Identifier: Apache-2.0
#include "integrate/guiding/guide_training.h"

#include <algorithm>

#include "base/hash.h"

namespace chromeball {
namespace {

constexpr uint32_t kMinSamples = 8;      // per pixel of a render that is guided
constexpr uint32_t kTraining = 16;       // samples per pixel; a quarter of the render, 4 to this
constexpr double kRecordsPerSample = 4;  // more in interiors, fewer where rays escape
// Ratio of second moments with and without the guide: below, `Auto` guides; above, there is nothing
// to gain.
constexpr double kWorthwhile = 0.8;
constexpr size_t kEnough = 20'000;  // records that prove the latter

}  // namespace

GuideTraining::GuideTraining(Guiding guiding, uint32_t samples, size_t pixels, size_t tiles)
    : guiding_(samples < kMinSamples ? Guiding::Off : guiding),
      lastSample_(std::clamp(samples / 4, 4u, kTraining)),
      maxRecordsOfTile_(std::max<size_t>(2 * kMaxRecords / tiles, 8)),
      pixelFraction_(double(kMaxRecords) / (kRecordsPerSample * double(pixels) * lastSample_)),
      records_(tiles) {}

bool GuideTraining::startPass(uint32_t done, uint32_t wanted) {
  if (guiding_ != Guiding::Off && done < lastSample_ && wanted <= lastSample_) return true;
  records_ = {};
  return false;
}

std::vector<LightRecord>* GuideTraining::recordsOf(size_t tile, uint64_t pixel) {
  const bool chosen = double(uint32_t(hash(pixel, 0x6775696465))) * 0x1p-32 < pixelFraction_;
  return chosen && records_[tile].size() < maxRecordsOfTile_ ? &records_[tile] : nullptr;
}

std::optional<double> GuideTraining::endPass() {
  size_t count = 0;
  for (const auto& some : records_) count += some.size();
  std::vector<LightRecord> all;
  all.reserve(count);
  for (const auto& some : records_) all.insert(all.end(), some.begin(), some.end());
  guide_.learn(std::move(all));
  const GuideRegion::Moments moments = guide_.moments();
  const double ratio = moments.without > 0 ? moments.with / moments.without : 1;
  if (guiding_ == Guiding::Auto && !hasBegun_ && ratio > kWorthwhile) {
    guide_.forget();
    if (count >= kEnough) guiding_ = Guiding::Off;
  }
  if (hasBegun_ || guide_.guidedRegions() == 0) return {};
  hasBegun_ = true;
  return ratio;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "integrate/guide_training.h"

#include <algorithm>

#include "base/hash.h"
#include "integrate/guide_gain.h"
#include "integrate/trace_photons.h"

namespace chromeball {
namespace {

// Samples per pixel: a quarter of the render within these limits.
constexpr uint32_t kMinTraining = 8, kTraining = 16;
constexpr double kRecordsPerSample = 4;  // more in interiors, fewer where rays escape
// Ratio of second moments with and without the guide: below, `Auto` guides light samples; above,
// there is nothing to gain.
constexpr double kWorthwhile = 0.8;
constexpr size_t kEnough = 20'000;  // records that prove the latter

constexpr double kPhotonRays = 0.15;  // relative to those of the render, which are estimated:
constexpr double kRaysPerSecond = 2e6;
constexpr double kSamplesUnderNoiseLimit = 256;

}  // namespace

uint32_t GuideTraining::samplesOf(const RenderSettings& settings) {
  if (settings.usedGuiding() == Guiding::Off || settings.samples < kMinSamples) return 0;
  const uint32_t samples = std::clamp(settings.samples / 4, kMinTraining, kTraining);
  return settings.shard.repeated > 0 ? std::min(samples, settings.shard.repeated) : samples;
}

GuideTraining::GuideTraining(const World& world, const LightSource& lighting,
                             const RenderSettings& settings)
    : world_(world),
      lighting_(lighting),
      settings_(settings),
      guiding_(settings.samples < kMinSamples || !lighting.canBeGuided() ? Guiding::Off
                                                                         : settings.usedGuiding()),
      lightGuiding_(guiding_),
      lastSample_(samplesOf(settings)),
      tiles_{settings.window().width, settings.window().height},
      maxRecordsOfTile_(std::max<size_t>(2 * kMaxRecords / tiles_.count(), 8)),
      pixelFraction_(double(kMaxRecords) / (kRecordsPerSample * tiles_.width * tiles_.height *
                                            std::max(lastSample_, 1u))),
      records_(guiding_ == Guiding::Off ? 0 : tiles_.count()) {}

PathSettings GuideTraining::guided(PathSettings path) const {
  path.guide = lightGuiding_ == Guiding::Off ? nullptr : &lights_;
  path.caustics = guiding_ == Guiding::Off ? nullptr : &caustics_;
  return path;
}

void GuideTraining::tracePhotons(double raysPerSample) {
  // Less bounces find no caustic. (Those in glass are not counted.)
  const int minDepth = std::ranges::any_of(world_.scene.materials, &Material::isBody) ? 1 : 2;
  if (guiding_ == Guiding::Off || settings_.maxDepth < minDepth) return;
  double samples = settings_.samples;
  if (settings_.noiseLimit) samples = std::min(samples, kSamplesUnderNoiseLimit);
  double rays = raysPerSample * samples * tiles_.width * tiles_.height;
  if (settings_.timeLimit) rays = std::min(rays, kRaysPerSecond * *settings_.timeLimit);
  caustics_ = CausticGuide(chromeball::tracePhotons(
      world_, lighting_, {kMaxPhotons, kPhotonRays * rays}, settings_.seed));
}

bool GuideTraining::startPass(uint32_t done, uint32_t wanted) const {
  const bool learns = lightGuiding_ != Guiding::Off || !caustics_.empty();
  return learns && done < lastSample_ && wanted <= lastSample_;
}

GuideRecords* GuideTraining::recordsOf(size_t tile, uint64_t pixel) {
  const bool chosen = double(uint32_t(hash(pixel, 0x6775696465))) * 0x1p-32 < pixelFraction_;
  if (!chosen) return nullptr;
  GuideRecords& records = records_[tile];
  records.wantsLights = lightGuiding_ != Guiding::Off;
  const size_t size = records.wantsLights ? records.lights.size() : records.bounces.size();
  return size < maxRecordsOfTile_ ? &records : nullptr;
}

std::optional<double> GuideTraining::learnLights() {
  if (lightGuiding_ == Guiding::Off) return {};
  size_t count = 0;
  for (const GuideRecords& some : records_) count += some.lights.size();
  std::vector<LightRecord> all;
  all.reserve(count);
  for (const GuideRecords& some : records_)
    all.insert(all.end(), some.lights.begin(), some.lights.end());
  lights_.learn(std::move(all));
  const GuideRegion::Moments moments = lights_.moments();
  const double ratio = moments.without > 0 ? moments.with / moments.without : 1;
  if (lightGuiding_ == Guiding::Auto && !hasBegun_ && ratio > kWorthwhile) {
    lights_.forget();
    if (count >= kEnough) lightGuiding_ = Guiding::Off;
  }
  if (hasBegun_ || lights_.guidedRegions() == 0) return {};
  hasBegun_ = true;
  return ratio;
}

void GuideTraining::end(const PixelErrors& errors, uint32_t samples) {
  if (records_.empty()) return;
  if (!caustics_.empty()) {
    const float fraction = bestFraction(records_, std::min(pixelFraction_, 1.0), tiles_, errors,
                                        samples, guiding_ == Guiding::On);
    if (fraction > 0)
      caustics_.setFraction(fraction);
    else
      caustics_ = CausticGuide();
  }
  records_ = {};
}

void GuideTraining::archive(Archive& a) {
  records_ = {};
  a.enumerator(lightGuiding_, Guiding::Auto);
  a(hasBegun_);
  lights_.archive(a);
  caustics_.archive(a);
}

}  // namespace chromeball

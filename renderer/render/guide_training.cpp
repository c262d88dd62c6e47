// SPDX-License-Identifier: Apache-2.0
#include "render/guide_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/hash.h"
#include "transport/trace_photons.h"

namespace chromeball {
namespace {

// Samples per pixel of the training: a quarter of the render's, within these limits.
constexpr uint32_t kMinTraining = 8, kTraining = 16;
constexpr double kRecordsPerSample = 4;  // more in interiors, fewer where rays escape
// Ratio of second moments with and without the guide: below, `Auto` guides light samples; above,
// there is nothing to gain.
constexpr double kWorthwhile = 0.8;
constexpr size_t kEnough = 20'000;  // records that prove the latter

constexpr double kPhotonRays = 0.15;  // relative to the render's, which are estimated:
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
  // Fewer bounces find no caustic. (Bounces in glass are not counted.)
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

std::optional<double> GuideTraining::learnLights(uint32_t samples) {
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
  if (lights_.guidedRegions() > 0) taught_ = samples;
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
  setTrained();
}

// All guides have learned from at most lastSample_ samples; a resumed render sets the same number.
void GuideTraining::setTrained() {
  records_ = {};
  taught_ = hasBegun_ ? lastSample_ : 0;
}

void GuideTraining::archive(Archive& a) {
  a.enumerator(lightGuiding_, Guiding::Auto);
  a(hasBegun_);
  lights_.archive(a);
  caustics_.archive(a);
  setTrained();
}

namespace {

constexpr std::array kFractions = {0.0f, 0.1f, 0.25f, 0.5f};
// Time of a path relative to that without a guide: more bounces meet glass and metal.
constexpr std::array kTimes = {1.0, 1.2, 1.3, 1.5};
constexpr double kDark = 0.01;  // as in the estimate of noise

template <class Visit>
void forErrors(size_t tile, const TileGrid& tiles, const PixelErrors& errors, const Visit& visit) {
  tiles.forPixels(tile, [&](int x, int y) {
    const size_t pixel = size_t(y) * size_t(tiles.width) + size_t(x);
    if (std::isfinite(errors.scatter[pixel].w))
      visit(errors.luminances[pixel], errors.scatter[pixel].w);
  });
}

double meanLuminance(size_t tile, const TileGrid& tiles, const PixelErrors& errors) {
  double sum = 0;
  size_t count = 0;
  forErrors(tile, tiles, errors, [&](double luminance, double) { sum += luminance, ++count; });
  return count > 0 ? sum / double(count) : 0;
}

}  // namespace

// The part of recorded light in a pixel's variance is E[x^2] / samples, and another fraction
// changes it by the ratio of the pdfs. Variances count relative to the luminance of the tile.
float bestFraction(std::span<const GuideRecords> records, double fractionOfPixels,
                   const TileGrid& tiles, const PixelErrors& errors, uint32_t samples,
                   bool always) {
  const double recordedSamples = samples * fractionOfPixels;
  std::vector<double> luminances(records.size());
  double mean = 0;
  for (size_t tile = 0; tile < records.size(); ++tile) {
    luminances[tile] = meanLuminance(tile, tiles, errors);
    mean += luminances[tile] / double(records.size());
  }
  double now = 0, recorded = 0;
  std::array<double, kFractions.size()> moments{};
  for (size_t tile = 0; tile < records.size(); ++tile) {
    const double luminance = std::max(luminances[tile], kDark * mean);
    if (!(luminance > 0)) continue;
    forErrors(tile, tiles, errors, [&](double ofPixel, double squared) {
      const double larger = std::max(ofPixel, luminance);  // highlights
      now += squared / (larger * larger);
    });
    const double scale = 1 / (luminance * luminance * samples * recordedSamples);
    double sum = 0, count = 0;
    tiles.forPixels(tile, [&](int, int) { count += recordedSamples; });
    for (const BounceRecord& r : records[tile].bounces) sum += double(r.found);
    const double squaredMean = scale * sum * sum / count;
    recorded -= squaredMean;
    for (double& moment : moments) moment -= squaredMean;
    for (const BounceRecord& r : records[tile].bounces) {
      const auto pdf = [&](float fraction) {
        return double(fraction) * double(r.lobesPdf) + (1 - double(fraction)) * double(r.bsdfPdf);
      };
      const double squared = scale * double(r.found) * double(r.found);
      recorded += squared;
      for (size_t k = 0; k < kFractions.size(); ++k)
        if (const double other = pdf(kFractions[k]); other > 0)
          moments[k] += squared * pdf(r.fraction) / other;
    }
  }
  const double rest = std::max(now - recorded, 0.0);
  const auto cost = [&](size_t k) { return (rest + moments[k]) * kTimes[k]; };
  size_t best = always ? 1 : 0;
  for (size_t k = best; k < kFractions.size(); ++k)
    if (cost(k) < cost(best)) best = k;
  return kFractions[best];
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Trains the guides with photons and the first passes of a render, and decides whether they are
// used at all.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film/noise.h"
#include "film/rows.h"
#include "render/render_settings.h"
#include "transport/context.h"
#include "transport/world.h"

namespace chromeball {

// The first passes of a render are its training. What is learned does not depend on the number of
// threads, because the records are kept by tile. Some kMaxRecords of either kind, at most twice as
// many, are taken, from pixels chosen at random if the image is large. They take 370 MB at most,
// and photons some 250 MB.
class GuideTraining {
 public:
  static constexpr size_t kMaxRecords = 1 << 20, kMaxPhotons = 1 << 20;
  static constexpr uint32_t kMinSamples = 8;  // per pixel of a render that is guided

  // The samples per pixel that the guides may learn from; 0 for a render without guides.
  static uint32_t samplesOf(const RenderSettings& settings);

  // All arguments must outlive this. Guides nothing if the strategy cannot be guided
  // (LightSource::canBeGuided()).
  GuideTraining(const World& world, const LightSource& lighting, const RenderSettings& settings);

  // The settings with the guides, which are empty at first.
  PathSettings guided(PathSettings path) const;

  // To be called before the first pass. `raysPerSample`: the approximate number of rays for a
  // sample of a pixel.
  void tracePhotons(double raysPerSample);

  const LightGuide& lights() const { return lights_; }
  const CausticGuide& caustics() const { return caustics_; }

  // Whether the pass from `done` to `wanted` samples per pixel is part of the training.
  bool startPass(uint32_t done, uint32_t wanted) const;
  // The place for records of the pixel's paths; null: none. Thread-safe for different tiles.
  GuideRecords* recordsOf(size_t tile, uint64_t pixel);

  // Trains the guide of light samples with all records so far, of `samples` per pixel. If guiding
  // begins: the weight of the samples so far relative to that of later ones, which have less
  // variance.
  std::optional<double> learnLights(uint32_t samples);
  // Decides which fraction of bounces is guided, if any. Frees the records. `errors`: the image's
  // so far, with `samples` per pixel. Does nothing if the training has ended before.
  void end(const PixelErrors& errors, uint32_t samples);
  bool hasEnded() const { return records_.empty(); }
  // How many samples per pixel, at most, taught the guides; 0: nothing is guided. Later samples of
  // a pixel must be independent of these: its next points of the same sequence would fill the gaps
  // between the first, to which the guide has adapted, and be biased.
  uint32_t taught() const { return taught_; }
  void archive(Archive& a);  // after the end

 private:
  void setTrained();

  const World& world_;
  const LightSource& lighting_;
  const RenderSettings& settings_;
  Guiding guiding_, lightGuiding_;  // the latter is off when nothing is to be gained
  bool hasBegun_ = false;           // from then on `Auto` keeps the guide of light samples
  uint32_t lastSample_, taught_ = 0;
  TileGrid tiles_;
  size_t maxRecordsOfTile_;
  double pixelFraction_;
  std::vector<GuideRecords> records_;  // by tile; empty after the training
  LightGuide lights_;
  CausticGuide caustics_;
};

// The gain by guided bounces, estimated from the records of a training.

// The fraction of bounces from the lobes that makes variances times time least; 0, unless `always`:
// none. `records`: by tile, of a fraction of the pixels, with `samples` each.
float bestFraction(std::span<const GuideRecords> records, double fractionOfPixels,
                   const TileGrid& tiles, const PixelErrors& errors, uint32_t samples, bool always);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What a light guide learns from the first passes of a render, and whether it is used at all.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "integrate/guiding/light_guide.h"

namespace chromeball {

// `Auto` guides if that is worth its time; `On` guides in every region where it reduces the
// variance.
enum class Guiding { Off, On, Auto };

// The first passes of a render are its training. What is learned does not depend on the number of
// threads, because the records are kept by tile. Some kMaxRecords, at most twice as many, are
// taken, from pixels chosen at random if the image is large. They take 330 MB at most.
class GuideTraining {
 public:
  static constexpr size_t kMaxRecords = 1 << 20;

  // `samples`: per pixel, of the whole render.
  GuideTraining(Guiding guiding, uint32_t samples, size_t pixels, size_t tiles);

  const LightGuide& guide() const { return guide_; }

  // Whether the pass from `done` to `wanted` samples per pixel is part of the training. Frees the
  // records after the last one.
  bool startPass(uint32_t done, uint32_t wanted);
  // Where a path of the pixel puts its records; null: nowhere. Thread-safe for different tiles.
  std::vector<LightRecord>* recordsOf(size_t tile, uint64_t pixel);

  // Learns from all records so far. If guiding begins: the weight of the samples so far relative to
  // that of later ones, which have less variance.
  std::optional<double> endPass();

 private:
  Guiding guiding_;
  bool hasBegun_ = false;  // from then on `Auto` keeps the guide
  uint32_t lastSample_;
  size_t maxRecordsOfTile_;
  double pixelFraction_;
  std::vector<std::vector<LightRecord>> records_;  // by tile
  LightGuide guide_;
};

}  // namespace chromeball

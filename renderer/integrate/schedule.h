// SPDX-License-Identifier: Apache-2.0
// How many samples a pixel has after each pass of a render.
#pragma once

#include <cstdint>

#include "base/stopwatch.h"
#include "film/film.h"
#include "integrate/render_settings.h"

namespace chromeball {

// The first pass takes a few samples per pixel; later passes double them, until a limit is near.
class Schedule {
 public:
  // Time limits count from here. `settings` must outlive this.
  explicit Schedule(const RenderSettings& settings);

  // Samples per pixel after the pass that follows `done` samples; at most `done` at the end.
  uint32_t next(uint32_t done, const Film& film);

  // Fraction of the work done after `samples`; NaN where only the noise decides.
  double progress(double samples) const;

 private:
  double untilTime(uint32_t done) const;
  double untilNoise(uint32_t done, const Film& film);

  const RenderSettings& settings_;
  Stopwatch elapsed_;
  struct {
    uint32_t samples = 0;
    double noise = 0;
  } last_;  // estimate
};

}  // namespace chromeball

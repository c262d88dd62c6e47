// SPDX-License-Identifier: Apache-2.0
// The number of samples per pixel after each pass of a render.
#pragma once

#include <cstdint>

#include "base/archive.h"
#include "base/progress.h"
#include "film/film.h"
#include "render/render_settings.h"

namespace chromeball {

// The first pass takes a few samples per pixel; each later pass doubles them, or takes fewer if a
// limit is near.
class Schedule {
 public:
  // The samples per pixel that each shard of an adaptive render takes first, whose noise allots the
  // later ones; 0 for other renders. `settings.samples`: the shard's.
  static uint32_t pilotSamples(const RenderSettings& settings);

  // Starts the clock of the time limit. `settings` must outlive this.
  explicit Schedule(const RenderSettings& settings);

  // Samples per pixel after the next pass, given `done` samples so far. A value <= done means that
  // the render is finished.
  uint32_t next(uint32_t done, const Film& film);

  // Seconds so far if the samples that are always taken took longer than the time limit; else 0.
  // Those are the first pass, and a pass of its own for a shard that first repeats another's.
  double overrun(uint32_t done) const;

  // Whether the samples so far are the pilot of an adaptive render, so that the pass that next()
  // returned last is the first whose samples are allotted by its noise.
  bool endsPilot() const { return endsPilot_; }

  // Completed fraction after `samples` samples per pixel. Under a noise limit without a time limit
  // it is an extrapolation of the noise, and NaN before the first estimate of that.
  double progress(double samples) const;

  // Reads or writes the state, with the time so far. `adapts`: whether the pilot has ended.
  void archive(Archive& a, bool adapts);

 private:
  uint32_t leastSamples() const;
  double goalAfter(uint32_t done, const Film& film);
  double untilTime(uint32_t done) const;
  double untilNoise(uint32_t done, const Film& film);

  double seconds() const { return before_ + elapsed_.seconds(); }

  const RenderSettings& settings_;
  Stopwatch elapsed_;
  double before_ = 0;  // seconds of rendering before it was resumed
  bool pilot_, endsPilot_ = false;
  double goal_ = 0;  // of goalAfter(); 0: none yet
  struct {
    uint64_t samples = 0;
    double noise = 0;
  } last_;  // the previous estimate of noise
};

}  // namespace chromeball

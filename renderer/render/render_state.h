// SPDX-License-Identifier: Apache-2.0
// A render between two tiles: everything that it needs to continue.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/archive.h"
#include "film/noise.h"
#include "render/guide_training.h"
#include "render/render.h"
#include "render/schedule.h"

namespace chromeball {

class LiveResult;

struct RenderState {
  RenderResult result;
  // Samples per pixel that have been taken by the passes so far, and after the pass in progress;
  // with those that a shard repeats.
  uint32_t done = 0, wanted = 0;
  std::vector<uint8_t> finished;               // by tile: 1 if it has them; empty between passes
  std::optional<SampleAllocation> allocation;  // none: the same number of samples everywhere
  Schedule schedule;
  GuideTraining* training = nullptr;  // of the integrator's guides; null: none

  // While the guides are being trained, their records are not stored.
  bool canBeStored() const { return !training || training->hasEnded(); }
  // Throws InputError for a state of an image of another size or with other layers.
  void archive(Archive& a);
};

// The tasks of a long render besides rendering.
class RenderControl {
 public:
  virtual ~RenderControl() = default;

  // Called before the first pass: fills the state from a checkpoint, and returns true, if there is
  // one.
  virtual bool restore(RenderState& state) = 0;
  // Called after each pass. No thread renders meanwhile.
  virtual void endPass(const RenderState&) {}
  // Whether pause() is to be called as soon as the tiles in work are finished. Thread-safe.
  virtual bool wantsPause(const RenderState& state) const = 0;
  // No thread renders meanwhile. The state may be one that cannot be stored.
  virtual void pause(RenderState& state) = 0;
  // The result for a thread that watches; null: none.
  virtual LiveResult* live() { return nullptr; }
  // Called after the last pass, and when the render is stopped; not while the guides are being
  // trained.
  virtual void end(RenderState& state) = 0;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A render in progress: between two tiles, everything that it needs to continue; and its result,
// for a thread that watches it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/archive.h"
#include "film/noise.h"
#include "film/rows.h"
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

// The result, for one thread that watches it.

// Lets a thread read the result while others continue to render: a tile in work is left out until
// later. Costs nothing if nobody reads.
class LiveResult {
 public:
  // Reads the pixels of a tile of TileGrid, which nobody changes meanwhile; the totals may change.
  using Read = std::function<void(const RenderResult& result, size_t tile)>;

  // Called by the thread that watches: `read` gets each tile that has changed since it last got it,
  // except tiles in work; at first, all. It gets the rest when the render ends, in a thread of the
  // render. Does nothing before the render begins.
  void update(Read read);

  // Called by the render. `result` must live until end(); an interrupted render may begin again.
  void begin(const RenderResult& result);
  void end();
  // While it exists, nothing is read: for changes of totals, and of the whole film, which
  // replaced() tells.
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(changing_); }
  void replaced();
  // Called before and after the work on a tile.
  void beginTile(size_t tile);
  void endTile(size_t tile);

 private:
  struct Tile {
    std::atomic<bool> isBusy = false;  // being worked on, or being read
    std::atomic<bool> hasChanged = true;
  };
  void readChanged();

  std::mutex changing_;
  const RenderResult* source_ = nullptr;
  TileGrid grid_{0, 0};
  std::unique_ptr<Tile[]> tiles_;
  Read read_;  // empty: nobody watches
};

}  // namespace chromeball

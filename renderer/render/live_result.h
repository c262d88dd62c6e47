// SPDX-License-Identifier: Apache-2.0
// The result of a render in progress, for one thread that watches it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "film/rows.h"
#include "render/render.h"

namespace chromeball {

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

// SPDX-License-Identifier: Apache-2.0
// The result of a render that goes on, for one thread that watches it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "film/rows.h"
#include "render/render.h"

namespace chromeball {

// The threads that render go on while the result is copied: of a tile that one of them works on,
// what was copied before stays. What nobody asks for costs nothing.
class LiveResult {
 public:
  // For the thread that watches: the result so far, up to date but for tiles in work, and valid
  // until the next call; null before the render begins. `changed`: tiles that differ from the last
  // call's, of TileGrid.
  const RenderResult* update(std::vector<size_t>& changed);

  // For the render. `result` must outlive the time until end(); an interrupted render may begin
  // again. `makeEmpty`: a result of the same size and layers; it is called before end().
  void begin(const RenderResult& result, std::function<RenderResult()> makeEmpty);
  void end();
  // While it exists, nothing is copied: for changes of totals, and of the whole film, which
  // replaced() tells.
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(changing_); }
  void replaced() { isReplaced_ = true; }
  // Around the work on a tile.
  void beginTile(size_t tile);
  void endTile(size_t tile);

 private:
  struct Tile {
    std::atomic<bool> isBusy = false;      // being worked on, or being copied
    std::atomic<bool> hasChanged = false;  // since it was copied
  };
  void copy();

  std::mutex changing_;
  const RenderResult* source_ = nullptr;
  std::function<RenderResult()> makeEmpty_;
  TileGrid grid_{0, 0};
  std::unique_ptr<Tile[]> tiles_;
  bool isReplaced_ = false;      // all that was copied before is of no use
  std::vector<size_t> changed_;  // since the last update()
  std::optional<RenderResult> copy_;
};

}  // namespace chromeball

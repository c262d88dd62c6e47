// SPDX-License-Identifier: Apache-2.0
#include "render/live_result.h"

#include <thread>
#include <utility>

namespace chromeball {

const RenderResult* LiveResult::update(std::vector<size_t>& changed) {
  const std::scoped_lock lock(changing_);
  if (source_) copy();
  changed = std::exchange(changed_, {});
  return copy_ ? &*copy_ : nullptr;
}

void LiveResult::begin(const RenderResult& result, std::function<RenderResult()> makeEmpty) {
  const std::scoped_lock lock(changing_);
  source_ = &result;
  makeEmpty_ = std::move(makeEmpty);
  grid_ = {result.film.width(), result.film.height()};
  tiles_ = std::make_unique<Tile[]>(grid_.count());
  isReplaced_ = true;
  copy_.reset();
}

// No thread renders.
void LiveResult::end() {
  const std::scoped_lock lock(changing_);
  if (source_ && copy_) copy();
  source_ = nullptr;
}

// A copy of a tile takes microseconds.
void LiveResult::beginTile(size_t tile) {
  while (tiles_[tile].isBusy.exchange(true, std::memory_order_acquire)) std::this_thread::yield();
}

void LiveResult::endTile(size_t tile) {
  tiles_[tile].hasChanged.store(true, std::memory_order_relaxed);
  tiles_[tile].isBusy.store(false, std::memory_order_release);
}

void LiveResult::copy() {
  const bool isWeighed = source_->film.isWeighed();
  if (!copy_ || (copy_->film.isWeighed() && !isWeighed)) copy_ = makeEmpty_();
  const bool everything = std::exchange(isReplaced_, false);
  copy_->copyTotals(*source_);
  if (isWeighed && !copy_->film.isWeighed()) copy_->film.beWeighed();
  for (size_t i = 0; i < grid_.count(); ++i) {
    Tile& tile = tiles_[i];
    if (everything) tile.hasChanged.store(true, std::memory_order_relaxed);
    if (!tile.hasChanged.load(std::memory_order_relaxed)) continue;
    if (tile.isBusy.exchange(true, std::memory_order_acquire)) continue;
    copy_->copyPixels(*source_, grid_.rectOf(i));
    tile.hasChanged.store(false, std::memory_order_relaxed);
    tile.isBusy.store(false, std::memory_order_release);
    changed_.push_back(i);
  }
}

}  // namespace chromeball

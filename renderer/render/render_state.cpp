// SPDX-License-Identifier: Apache-2.0
#include "render/render_state.h"

#include <thread>
#include <utility>

namespace chromeball {

void RenderState::archive(Archive& a) {
  result.archive(a);
  a(done);
  a(wanted);
  a.check(done <= wanted);
  a(finished);
  const TileGrid tiles{result.film.width(), result.film.height()};
  a.check(finished.empty() || finished.size() == tiles.count());
  bool isAdaptive = allocation.has_value();
  a(isAdaptive);
  if (isAdaptive) {
    if (a.reads()) allocation.emplace(result.film.width(), result.film.height());
    allocation->archive(a);
  }
  schedule.archive(a, isAdaptive);
  if (training) training->archive(a);
}

void LiveResult::update(Read read) {
  const std::scoped_lock lock(changing_);
  read_ = std::move(read);
  if (source_) readChanged();
}

void LiveResult::begin(const RenderResult& result) {
  const std::scoped_lock lock(changing_);
  source_ = &result;
  grid_ = {result.film.width(), result.film.height()};
  tiles_ = std::make_unique<Tile[]>(grid_.count());
}

// No thread renders now.
void LiveResult::end() {
  const std::scoped_lock lock(changing_);
  if (source_ && read_) readChanged();
  source_ = nullptr;
}

void LiveResult::replaced() {
  for (size_t i = 0; i < grid_.count(); ++i) tiles_[i].hasChanged = true;
}

// Reading a tile takes microseconds.
void LiveResult::beginTile(size_t tile) {
  while (tiles_[tile].isBusy.exchange(true, std::memory_order_acquire)) std::this_thread::yield();
}

void LiveResult::endTile(size_t tile) {
  tiles_[tile].hasChanged.store(true, std::memory_order_relaxed);
  tiles_[tile].isBusy.store(false, std::memory_order_release);
}

void LiveResult::readChanged() {
  for (size_t i = 0; i < grid_.count(); ++i) {
    Tile& tile = tiles_[i];
    if (!tile.hasChanged.load(std::memory_order_relaxed)) continue;
    if (tile.isBusy.exchange(true, std::memory_order_acquire)) continue;
    read_(*source_, i);
    tile.hasChanged.store(false, std::memory_order_relaxed);
    tile.isBusy.store(false, std::memory_order_release);
  }
}

}  // namespace chromeball

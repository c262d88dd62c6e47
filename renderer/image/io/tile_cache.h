// SPDX-License-Identifier: Apache-2.0
// A temporary file of tiles, of which a limited number is kept in memory.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>

namespace chromeball {

inline constexpr int kTileBytes = 1 << 14;

struct alignas(16) TileContents {
  std::array<uint8_t, kTileBytes> bytes;
};

class TileCache {
 public:
  using Tile = std::shared_ptr<const TileContents>;

  // `bytes`: of tiles in memory; who holds a tile keeps it beyond that. Throws RunError if the file
  // cannot be created.
  explicit TileCache(size_t bytes);
  ~TileCache();
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  // Appends whole tiles to the file. Throws RunError if that fails.
  void append(std::span<const uint8_t> bytes);

  // Tile `index` of the file, in the order in which they were appended; null if it cannot be read,
  // which check() reports from then on.
  Tile get(uint64_t index);
  void check() const;  // throws RunError

  uint64_t byteCount() const { return size_; }  // of the file
  size_t cacheBytes() const { return cacheBytes_; }

 private:
  // The tiles with equal index modulo kShards, the one that was used last in front.
  struct Shard {
    struct Entry {
      uint64_t index;
      Tile tile;
    };
    std::mutex mutex;
    std::list<Entry> entries;
    std::unordered_map<uint64_t, std::list<Entry>::iterator> places;
  };
  static constexpr size_t kShards = 64;

  Tile read(uint64_t index);
  void fail(const std::string& reason);

  std::string folder_;
  size_t cacheBytes_;
  int file_ = -1;
  uint64_t size_ = 0;
  std::array<Shard, kShards> shards_;
  std::atomic<bool> hasFailed_ = false;
  mutable std::mutex failing_;
  std::string failure_;  // the first
};

}  // namespace chromeball

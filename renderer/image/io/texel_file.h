// SPDX-License-Identifier: Apache-2.0
// Texels beyond memory: kept in a temporary file, read through a cache of tiles.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// The file has no name: it vanishes with the process, however that ends. It is in the folder for
// temporary files ($TMPDIR).
class TexelFile {
 public:
  using Texel8 = std::array<uint8_t, 4>;

  // The cache holds `cacheBytes` of tiles, and never less than kMinCacheBytes. In addition, each
  // reading thread holds at most kBytesPerThread. Throws RunError if the file cannot be created.
  explicit TexelFile(size_t cacheBytes);
  ~TexelFile();
  TexelFile(const TexelFile&) = delete;
  TexelFile& operator=(const TexelFile&) = delete;

  static constexpr size_t kMinCacheBytes = 10 << 20, kBytesPerThread = 1 << 20;

  // Appends an image of width x height texels; returns its index. Not to be called while texels are
  // read. Throws RunError if the file cannot be written.
  int add(int width, int height, const std::vector<Texel8>& texels);
  int add(int width, int height, const std::vector<vec4>& texels);

  bool has8Bits(int image) const;
  // A texel of an image that was added with texels of this type. 0 after a failure to read, which
  // check() reports.
  Texel8 texel8(int image, int x, int y) const;
  vec4 texelFloat(int image, int x, int y) const;

  // Throws RunError if a texel could not be read.
  void check() const;

  size_t byteCount() const;   // of the file
  size_t cacheBytes() const;  // the most that the cache holds

 private:
  struct State;
  template <class Texel>
  int append(int width, int height, const std::vector<Texel>& texels);
  template <class Texel>
  Texel fetch(int image, int x, int y) const;

  std::unique_ptr<State> state_;
};

// A temporary file of tiles; a limited number of them is kept in memory.

inline constexpr int kTileBytes = 1 << 14;

struct alignas(16) TileContents {
  std::array<uint8_t, kTileBytes> bytes;
};

class TileCache {
 public:
  using Tile = std::shared_ptr<const TileContents>;

  // `bytes`: the limit for tiles in memory; a tile in use stays beyond that. Throws RunError if the
  // file cannot be created.
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

// SPDX-License-Identifier: Apache-2.0
// A temporary file of tiles behind OpenImageIO's ImageCache, which keeps a limited number of them
// in memory.
#pragma once

#include <OpenImageIO/imagecache.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <span>
#include <string>

namespace chromeball {

inline constexpr int kTileBytes = 1 << 14;

struct CachedTile {
  OIIO::ImageCache::Tile* handle = nullptr;  // null: none
  const void* texels = nullptr;
};

class TileCache {
 public:
  using Reader = OIIO::ImageCache::Perthread;  // of one thread

  // An image of square tiles, by rows, each tile of kTileBytes.
  struct Image {
    TileCache* owner;
    int width, height, tileSide;  // in texels
    OIIO::TypeDesc type;          // of each of four channels
    uint64_t offset;              // of the first tile in the file
    OIIO::ImageCache::ImageHandle* handle = nullptr;
  };

  // `bytes`: of tiles in memory. Throws RunError if the file cannot be created.
  explicit TileCache(size_t bytes);
  ~TileCache();
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  // Appends bytes to the file. Throws RunError if that fails.
  void append(std::span<const uint8_t> bytes);
  // Adds an image whose tiles have been appended from `image.offset` on.
  void add(Image image);

  Reader* makeReader() { return cache_->create_thread_info(); }
  void release(Reader* reader) { cache_->destroy_thread_info(reader); }

  // Tile (x, y), counted in tiles; without handle if it cannot be read. To be released.
  CachedTile get(Reader* reader, int image, int x, int y);
  void release(const CachedTile& tile) { cache_->release_tile(tile.handle); }

  // Reads a tile from the file; false if that fails, which check() reports from then on.
  bool readTile(const Image& image, int x, int y, void* texels);
  void check() const;  // throws RunError

  uint64_t byteCount() const { return size_; }
  size_t cacheBytes() const { return cacheBytes_; }

 private:
  void fail(const std::string& reason);

  std::string folder_;
  size_t cacheBytes_;
  int file_ = -1;
  uint64_t size_ = 0;
  std::deque<Image> images_;
  OIIO::ImageCache* cache_ = nullptr;
  std::atomic<bool> hasFailed_ = false;
  std::mutex failing_;
  std::string failure_;  // the first
};

}  // namespace chromeball

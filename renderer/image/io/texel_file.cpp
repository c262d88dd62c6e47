// SPDX-License-Identifier: Apache-2.0
#include "image/io/texel_file.h"

#include <algorithm>
#include <cstring>

#include "base/parallel.h"
#include "image/io/tile_cache.h"

namespace chromeball {
namespace {

// Tiles have 2^kTileShift texels per side, so that a tile has kTileBytes.
template <class Texel>
constexpr int kTileShift = sizeof(Texel) == 4 ? 6 : 5;
template <class Texel>
constexpr int kTileSide = 1 << kTileShift<Texel>;

struct StoredImage {
  uint64_t firstTile, tilesPerRow;
  bool has8Bits;
};

// The tiles that a thread has read last: a look-up in the cache locks, and takes as long as ten
// texels. Tiles have fixed places, by which 8 x 8 neighbours never displace one another.
class RecentTiles {
 public:
  static constexpr int kSide = 8, kCount = kSide * kSide;

  explicit RecentTiles(TileCache* cache) : cache_(*cache) {}
  RecentTiles(const RecentTiles&) = delete;
  RecentTiles& operator=(const RecentTiles&) = delete;

  // The texels of tile (x, y) of an image, counted in tiles; null if it cannot be read.
  const void* find(const StoredImage& image, int index, int x, int y) {
    const int spread = index * 29 % kCount;
    Entry& entry = entries_[size_t((x % kSide + kSide * (y % kSide)) ^ spread)];
    if (entry.image == index && entry.x == x && entry.y == y) [[likely]]
      return entry.tile->bytes.data();
    return replace(entry, image, index, x, y);
  }

 private:
  struct Entry {
    TileCache::Tile tile;
    int image = -1, x = 0, y = 0;
  };

  [[gnu::noinline]] const void* replace(Entry& entry, const StoredImage& image, int index, int x,
                                        int y) {
    entry = {};
    TileCache::Tile tile =
        cache_.get(image.firstTile + uint64_t(y) * image.tilesPerRow + uint64_t(x));
    if (!tile) return nullptr;
    entry = {std::move(tile), index, x, y};
    return entry.tile->bytes.data();
  }

  TileCache& cache_;
  std::array<Entry, kCount> entries_ = {};
};

static_assert(RecentTiles::kCount * size_t(kTileBytes) == TexelFile::kBytesPerThread);

uint64_t nextId() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

// The tiles that this thread has of the file that it read last: the look-up of a thread's own value
// would take longer than that of a texel.
struct LastUsed {
  uint64_t file = 0;
  RecentTiles* tiles = nullptr;
};
thread_local LastUsed lastUsed;

}  // namespace

struct TexelFile::State {
  explicit State(size_t cacheBytes) : cache(cacheBytes) {}

  RecentTiles& recentTiles() {
    if (lastUsed.file != id) lastUsed = {id, &threads.local()};
    return *lastUsed.tiles;
  }

  const uint64_t id = nextId();
  TileCache cache;
  std::vector<StoredImage> images;
  PerThread<RecentTiles> threads{[this] { return RecentTiles(&cache); }};
};

TexelFile::TexelFile(size_t cacheBytes)
    : state_(std::make_unique<State>(std::max(cacheBytes, kMinCacheBytes))) {}

TexelFile::~TexelFile() = default;

template <class Texel>
int TexelFile::append(int width, int height, const std::vector<Texel>& texels) {
  constexpr int kSide = kTileSide<Texel>;
  TileCache& cache = state_->cache;
  const size_t tilesPerRow = (size_t(width) + kSide - 1) / kSide;
  const StoredImage image{cache.byteCount() / kTileBytes, tilesPerRow, sizeof(Texel) == 4};
  std::vector<uint8_t> row(tilesPerRow * kTileBytes);  // of tiles
  for (int y0 = 0; y0 < height; y0 += kSide) {
    for (int y = y0; y < std::min(y0 + kSide, height); ++y)
      for (size_t tile = 0; tile < tilesPerRow; ++tile) {
        const size_t x0 = tile * kSide, count = std::min<size_t>(kSide, size_t(width) - x0);
        std::memcpy(&row[tile * kTileBytes + size_t(y - y0) * kSide * sizeof(Texel)],
                    &texels[size_t(y) * size_t(width) + x0], count * sizeof(Texel));
      }
    cache.append(row);
  }
  state_->images.push_back(image);
  return int(state_->images.size()) - 1;
}

int TexelFile::add(int width, int height, const std::vector<Texel8>& texels) {
  return append(width, height, texels);
}

int TexelFile::add(int width, int height, const std::vector<vec4>& texels) {
  return append(width, height, texels);
}

template <class Texel>
Texel TexelFile::fetch(int image, int x, int y) const {
  constexpr int kShift = kTileShift<Texel>, kMask = kTileSide<Texel> - 1;
  const void* tile =
      state_->recentTiles().find(state_->images[size_t(image)], image, x >> kShift, y >> kShift);
  if (!tile) return Texel{};
  const size_t index = size_t(y & kMask) << kShift | size_t(x & kMask);
  return static_cast<const Texel*>(tile)[index];
}

TexelFile::Texel8 TexelFile::texel8(int image, int x, int y) const {
  return fetch<Texel8>(image, x, y);
}

vec4 TexelFile::texelFloat(int image, int x, int y) const { return fetch<vec4>(image, x, y); }

bool TexelFile::has8Bits(int image) const { return state_->images[size_t(image)].has8Bits; }

void TexelFile::check() const { state_->cache.check(); }

size_t TexelFile::byteCount() const { return state_->cache.byteCount(); }

size_t TexelFile::cacheBytes() const { return state_->cache.cacheBytes(); }

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "image/io/texel_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/parallel.h"

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
// texels. Tiles have fixed places, so that 8 x 8 neighbours never displace one another.
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

// This thread's tiles of the file that it read last: looking up a thread's own value would take
// longer than looking up a texel.
struct LastUsed {
  uint64_t file = 0;
  RecentTiles* tiles = nullptr;
};
thread_local LastUsed lastUsed;

std::string temporaryFolder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) throwRun("TMPDIR: no folder for a temporary file for textures: {}", error.message());
  return folder;
}

// A file without a name, in `folder`.
int openTemporary(const std::string& folder) {
  std::string name = folder + "/chromeball-texels-XXXXXX";
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) unlink(name.c_str());
  return file;
}

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

TileCache::TileCache(size_t bytes) : folder_(temporaryFolder()), cacheBytes_(bytes) {
  file_ = openTemporary(folder_);
  if (file_ < 0)
    throwRun("{}: no temporary file for textures can be created: {}", folder_,
             std::strerror(errno));
}

TileCache::~TileCache() { close(file_); }

void TileCache::append(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_, bytes.data(), bytes.size(), off_t(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throwRun("{}: the temporary file for textures cannot be written: {}", folder_,
               std::strerror(errno));
    size_ += uint64_t(written);
    bytes = bytes.subspan(size_t(written));
  }
}

TileCache::Tile TileCache::get(uint64_t index) {
  if (hasFailed_) return nullptr;
  Shard& shard = shards_[index % kShards];
  const auto find = [&]() -> Tile {
    const auto found = shard.places.find(index);
    if (found == shard.places.end()) return nullptr;
    shard.entries.splice(shard.entries.begin(), shard.entries, found->second);
    return found->second->tile;
  };
  {
    const std::lock_guard lock(shard.mutex);
    if (Tile tile = find()) return tile;
  }
  Tile tile = read(index);  // others use the shard meanwhile
  if (!tile) return nullptr;
  const std::lock_guard lock(shard.mutex);
  if (Tile other = find()) return other;
  shard.entries.push_front({index, tile});
  shard.places[index] = shard.entries.begin();
  if (shard.entries.size() * kShards * kTileBytes > cacheBytes_) {
    shard.places.erase(shard.entries.back().index);
    shard.entries.pop_back();
  }
  return tile;
}

TileCache::Tile TileCache::read(uint64_t index) {
  const auto tile = std::make_shared<TileContents>();
  for (size_t done = 0; done < kTileBytes;) {
    const ssize_t count = pread(file_, tile->bytes.data() + done, kTileBytes - done,
                                off_t(index * kTileBytes + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      fail(count < 0 ? std::strerror(errno) : "it has become shorter");
      return nullptr;
    }
    done += size_t(count);
  }
  return tile;
}

void TileCache::fail(const std::string& reason) {
  const std::lock_guard lock(failing_);
  if (failure_.empty()) failure_ = reason;
  hasFailed_ = true;
}

void TileCache::check() const {
  if (!hasFailed_) return;
  const std::lock_guard lock(failing_);
  throwRun("{}: the temporary file for textures cannot be read: {}", folder_, failure_);
}

}  // namespace chromeball

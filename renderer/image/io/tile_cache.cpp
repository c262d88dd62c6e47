// SPDX-License-Identifier: Apache-2.0
#include "image/io/tile_cache.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"

namespace chromeball {
namespace {

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

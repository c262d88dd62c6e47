// SPDX-License-Identifier: Apache-2.0
#include "session/cache_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "base/archive.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "session/image_header.h"

namespace chromeball {
namespace {

// The file: magic, checksum of the rest, identity, records. In the byte order of the machine.
constexpr std::array<char, 16> kMagic{'c', 'h', 'r', 'o', 'm', 'e', 'b', 'a',
                                      'l', 'l', ' ', 'c', 'a', 'c', 'h', 'e'};
constexpr size_t kHeader = kMagic.size() + sizeof(uint64_t);

}  // namespace

CacheFile::CacheFile(const LoadedScene& loaded)
    : cache_(loaded.description.settings.cacheError.value()), path_(loaded.description.run.cache) {
  if (!path_) return;
  checkReplaceable(*path_);
  identity_ = lightIdentity(loaded);
  if (std::filesystem::exists(*path_)) read();
}

void CacheFile::read() {
  const std::vector<uint8_t> bytes = readFile(*path_);
  const std::span contents(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (contents.size() < kHeader || !std::equal(kMagic.begin(), kMagic.end(), contents.begin()))
    throwInput("{}: is not an irradiance cache", *path_);
  const std::span<const char> rest = contents.subspan(kHeader);
  uint64_t stored = 0;
  std::memcpy(&stored, contents.data() + kMagic.size(), sizeof(stored));
  if (stored != checksum(rest)) throwInput("{}: damaged: its checksum differs", *path_);
  MemoryReader reader(rest, *path_);
  std::string identity;
  reader(identity);
  if (identity != identity_)
    throwInput("{}: is the cache of another scene: {}", *path_, differenceOf(identity, identity_));
  cache_.archive(reader);
  inFile_ = cache_.size();
}

void CacheFile::write() {
  if (!path_ || cache_.size() == inFile_) return;
  MemoryWriter writer;
  writer(identity_);
  cache_.archive(writer);
  const uint64_t sum = checksum(writer.contents);
  std::vector<uint8_t> bytes(kHeader + writer.contents.size());
  std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
  std::memcpy(bytes.data() + kMagic.size(), &sum, sizeof(sum));
  std::copy(writer.contents.begin(), writer.contents.end(), bytes.begin() + kHeader);
  writeFile(*path_, bytes);
  inFile_ = cache_.size();
}

}  // namespace chromeball

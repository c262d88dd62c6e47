// SPDX-License-Identifier: Apache-2.0
// Texels beyond memory: kept in a temporary file, read through a cache of tiles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// The file has no name: it vanishes with the process, however that ends. It is in the folder for
// temporary files ($TMPDIR).
class TexelFile {
 public:
  using Texel8 = std::array<uint8_t, 4>;

  // The cache holds `cacheBytes` of tiles, and never less than kMinCacheBytes. Besides, each thread
  // that reads holds on to at most kBytesPerThread. Throws RunError if the file cannot be created.
  explicit TexelFile(size_t cacheBytes);
  ~TexelFile();
  TexelFile(const TexelFile&) = delete;
  TexelFile& operator=(const TexelFile&) = delete;

  static constexpr size_t kMinCacheBytes = 10 << 20, kBytesPerThread = 1 << 20;

  // Appends an image of width x height texels; returns its index. Not while texels are read. Throws
  // RunError if the file cannot be written.
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

}  // namespace chromeball

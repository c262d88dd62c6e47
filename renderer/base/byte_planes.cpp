// SPDX-License-Identifier: Apache-2.0
#include "base/byte_planes.h"

#include <algorithm>
#include <cstring>

namespace chromeball {
namespace {

constexpr size_t kTile = 256;  // items that stay in the cache while their bytes are sorted

// OR of the differences of all items to the first one, by byte.
std::vector<char> differencesOf(const char* items, size_t count, size_t size) {
  std::vector<char> differs(size, 0);
  for (size_t i = 1; i < count; ++i)
    for (size_t b = 0; b < size; ++b) differs[b] |= char(items[i * size + b] ^ items[b]);
  return differs;
}

}  // namespace

void packPlanes(const char* items, size_t count, size_t size, std::vector<char>& packed) {
  if (count == 0) return;
  const std::vector<char> differs = differencesOf(items, count, size);
  std::vector<size_t> places;  // of the planes; what follows their flags
  size_t end = packed.size();
  for (size_t b = 0; b < size; ++b) {
    places.push_back(end + 1);
    end += 1 + (differs[b] ? count : 1);
  }
  packed.resize(end);
  for (size_t b = 0; b < size; ++b) {
    packed[places[b] - 1] = differs[b] ? 1 : 0;
    packed[places[b]] = items[b];
  }
  for (size_t first = 0; first < count; first += kTile) {
    const size_t last = std::min(count, first + kTile);
    for (size_t b = 0; b < size; ++b)
      for (size_t i = first; i < last && differs[b]; ++i)
        packed[places[b] + i] = items[i * size + b];
  }
}

std::optional<size_t> unpackPlanes(std::span<const char> packed, size_t count, size_t size,
                                   char* items) {
  if (count == 0) return 0;
  std::vector<const char*> planes(size);
  std::vector<size_t> steps(size);  // 0: all items have the same byte
  size_t at = 0;
  for (size_t b = 0; b < size; ++b) {
    if (at >= packed.size() || (packed[at] != 0 && packed[at] != 1)) return {};
    steps[b] = size_t(packed[at++]);
    planes[b] = packed.data() + at;
    const size_t length = steps[b] ? count : 1;
    if (length > packed.size() - at) return {};
    at += length;
  }
  for (size_t first = 0; first < count; first += kTile) {
    const size_t last = std::min(count, first + kTile);
    for (size_t b = 0; b < size; ++b)
      for (size_t i = first; i < last; ++i) items[i * size + b] = planes[b][i * steps[b]];
  }
  return at;
}

}  // namespace chromeball

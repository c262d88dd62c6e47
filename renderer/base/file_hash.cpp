// SPDX-License-Identifier: Apache-2.0
#include "base/file_hash.h"

#include <algorithm>
#include <cstring>

#include "base/file.h"
#include "base/hash.h"

namespace chromeball {

uint64_t fingerprint(const std::string& path) {
  const std::vector<uint8_t> bytes = readFile(path);
  uint64_t state = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += sizeof state) {
    uint64_t word = 0;
    std::memcpy(&word, &bytes[i], std::min(sizeof word, bytes.size() - i));
    state = hash(state ^ word);
  }
  return state;
}

}  // namespace chromeball

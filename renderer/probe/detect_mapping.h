// SPDX-License-Identifier: Apache-2.0
// Which mapping an image most likely is in.
#pragma once

#include <string>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

struct MappingGuess {
  Mapping mapping;
  std::string reason;
  bool certain;  // false: worth a warning
};

// By shape; of a square image and of a cross, by whether it is black where the mapping shows
// nothing.
MappingGuess guessMapping(const Image& image);

}  // namespace chromeball

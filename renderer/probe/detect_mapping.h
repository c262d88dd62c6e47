// SPDX-License-Identifier: Apache-2.0
// Detects the mapping of an image from its shape and its texels.
#pragma once

#include <string>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

struct DetectedMapping {
  Mapping mapping;
  std::string reason;  // completes a sentence: "because its shape is 2:1"
  bool certain;        // false: the user should be warned
};

// The shape decides; for squares and crosses, also whether the image is black where the mapping
// shows no direction. An angular map and an ideal mirror ball may both be black outside the same
// disc: their texels do not tell which they are, and the angular map is the usual one.
DetectedMapping detectMapping(const Image& image);

}  // namespace chromeball

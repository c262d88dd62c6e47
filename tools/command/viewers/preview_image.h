// SPDX-License-Identifier: Apache-2.0
// The parts of an image that a preview shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"
#include "image/io/write_image.h"

namespace chromeball {

struct ImageView {
  std::string layer;  // empty: the colour
  DisplayTransform display;
  int maxWidth = 0;  // pixels; wider images are reduced by a whole factor. 0: no limit
};

// A .png. Throws InputError for a layer that the image does not have.
std::vector<uint8_t> pngOf(const OutputImage& image, const ImageView& view);

// The values of each layer: {"albedo": ["0.25", ...]}. Text, since JSON has neither NaN nor
// infinity. Throws InputError outside the image.
nlohmann::json valuesAt(const OutputImage& image, int x, int y);

}  // namespace chromeball

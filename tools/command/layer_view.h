// SPDX-License-Identifier: Apache-2.0
// A render's layers as images for display.
#pragma once

#include <map>
#include <string>

#include "image/image.h"
#include "measure/false_color.h"

namespace chromeball {

// The image to display (linear; [0, 1] unless it is radiance) for a layer of this name:
//   depth           nearest white, farthest nearly black, black if nothing was hit
//   normal          -1..1 as 0..1
//   node, material  one color for each number, 0 black
//   variance        standard error of the luminance, in false colors over three decades
//   samples         in false colors, relative to the maximum
//   invalid         each cause (R, G, B) relative to its maximum
// Others are unchanged.
Image layerView(const std::string& name, Image layer);

bool isOfIds(const std::string& name);  // node or material
Color8 idColor(int id);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A render's layers as pictures that people can read.
#pragma once

#include <map>
#include <string>

#include "image/image.h"
#include "measure/false_color.h"

namespace chromeball {

// What a screen should show (linear, [0, 1] where it is no radiance) of a layer, by its name:
//   depth           nearest white, farthest nearly black; where nothing was hit, black
//   normal          -1..1 as 0..1
//   node, material  a colour of its own for each number, 0 black
//   variance        standard error of the luminance, in false colours over three decades
//   samples         in false colours, the most frequented pixel brightest
//   invalid         each cause (R, G, B) in proportion to its most frequent pixel
// Others stay as they are.
Image layerView(const std::string& name, Image layer);

bool isOfIds(const std::string& name);  // node or material
Color8 idColor(int id);

}  // namespace chromeball

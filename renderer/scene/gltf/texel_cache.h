// SPDX-License-Identifier: Apache-2.0
// Decoded images that several loads of one model share, as for the frames of an animation.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/texture.h"

namespace chromeball {

using MipChain = std::shared_ptr<const std::vector<TexelGrid>>;

struct TexelCache {
  std::map<std::pair<std::string, int>, std::shared_ptr<TexelGrid>> grids;  // by file and image
  // By image, and by Texture::srgb and Texture::weightedByAlpha.
  std::map<std::tuple<const TexelGrid*, bool, bool>, MipChain> chains;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Decoded images that several loads of one model share, as for the frames of an animation.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "image/io/texel_file.h"
#include "scene/texture.h"

namespace chromeball {

using MipChain = std::shared_ptr<const std::vector<TexelGrid>>;

struct TexelCache {
  double limit = INFINITY;          // bytes; more texels in memory are refused
  double memory = INFINITY;         // bytes for texels in memory; with more, they go to `file`
  double used = 0;                  // of it, by grids and chains in memory
  std::shared_ptr<TexelFile> file;  // null: all are in memory; else it caches the rest of `memory`

  std::map<std::pair<std::string, int>, std::shared_ptr<TexelGrid>> grids;  // by file and image
  // By image, and by Texture::srgb and Texture::weightedByAlpha.
  std::map<std::tuple<const TexelGrid*, bool, bool>, MipChain> chains;
};

}  // namespace chromeball

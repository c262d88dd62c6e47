// SPDX-License-Identifier: Apache-2.0
// Decodes the images of a model, into memory or a temporary file.
#pragma once

#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"

namespace chromeball {

// Mip levels to make for an image; see makeMipLevels().
struct ChainToMake {
  bool srgb = false, weightedByAlpha = false;
  MipChain* chain = nullptr;
};

struct ImageToDecode {
  int image = 0;              // index in the file
  TexelGrid* grid = nullptr;  // filled unless it already is
  std::vector<ChainToMake> chains;
};

// Decodes the images that are missing, in parallel. If all together would exceed `cache.memory`,
// they go to `cache.file`, one after another. Throws InputError for a damaged image, and, before
// any is decoded, if all together exceed `cache.limit`; RunError if the temporary file cannot be
// written.
void decodeImages(const GltfFile& file, const std::vector<ImageToDecode>& images,
                  TexelCache& cache);

}  // namespace chromeball

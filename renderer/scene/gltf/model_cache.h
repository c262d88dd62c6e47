// SPDX-License-Identifier: Apache-2.0
// What several loads of one model share, as for the frames of an animation.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "scene/gltf/mesh_cache.h"
#include "scene/gltf/texel_cache.h"

namespace chromeball {

class GltfFile;

struct ModelCache {
  TexelCache texels;
  MeshCache meshes;

  bool keepsFiles = false;  // open and decoded, with their buffers
  // By path, animation and variant, which change the file's nodes and materials.
  std::map<std::string, std::shared_ptr<GltfFile>> files;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Data that several loads of one model share, as for the frames of an animation.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "image/io/texel_file.h"
#include "scene/mesh.h"
#include "scene/texture.h"

namespace chromeball {

struct TexelCache {
  double limit = INFINITY;          // bytes; more texels in memory are refused
  double memory = INFINITY;         // bytes for texels in memory; with more, they go to `file`
  double used = 0;                  // of it, by grids and chains in memory
  std::shared_ptr<TexelFile> file;  // null: all are in memory; else it caches the rest of `memory`

  std::map<std::pair<std::string, int>, std::shared_ptr<TexelGrid>> grids;  // by file and image
  // Keyed by image, and by Texture::srgb and Texture::weightedByAlpha.
  std::map<std::tuple<const TexelGrid*, bool, bool>, MipChain> chains;
};

// Everything that determines an unskinned mesh: primitives with equal recipes have equal meshes.
struct MeshRecipe {
  int mode, indices;
  std::map<std::string, int> attributes;
  std::vector<std::map<std::string, int>> targets;
  std::vector<double> weights;
  std::vector<int> uvSets;             // those that the material reads
  std::vector<uint32_t> tangentSpace;  // UV set and the bits of its transform; empty: no tangents
  bool hasAlpha;                       // kept apart: tracing is faster if no mesh mixes the two

  auto operator<=>(const MeshRecipe&) const = default;
};

// Everything that determines a mesh of a scene.
struct MeshKey {
  std::string file;
  MeshRecipe recipe;
  bool isSkinned = false;
  std::vector<double> placement;  // matrices of the joints, or of the node; empty: neither

  auto operator<=>(const MeshKey&) const = default;
};

struct ReadMesh {
  std::shared_ptr<const Mesh> mesh;
  glm::dvec3 origin{0};  // of its coordinates
};

// Does not keep meshes alive: it knows the meshes that some scene has.
class MeshCache {
 public:
  // A null mesh if no scene has it.
  ReadMesh find(const MeshKey& key) const {
    const auto found = meshes_.find(key);
    if (found == meshes_.end()) return {};
    return {found->second.mesh.lock(), found->second.origin};
  }
  void add(MeshKey key, const ReadMesh& read) {
    meshes_[std::move(key)] = {read.mesh, read.origin};
  }
  void forgetUnused() {
    std::erase_if(meshes_, [](const auto& entry) { return entry.second.mesh.expired(); });
  }

 private:
  struct Known {
    std::weak_ptr<const Mesh> mesh;
    glm::dvec3 origin{0};
  };
  std::map<MeshKey, Known> meshes_;
};

class GltfFile;

struct ModelCache {
  TexelCache texels;
  MeshCache meshes;

  bool keepsFiles = false;  // open and decoded, with their buffers
  // Keyed by path, animation and variant, which change the file's nodes and materials.
  std::map<std::string, std::shared_ptr<GltfFile>> files;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Meshes that several loads of one model share, as for the frames of an animation.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/mesh_recipe.h"
#include "scene/mesh.h"

namespace chromeball {

// Everything that determines a mesh of a scene.
struct MeshKey {
  std::string file;
  MeshRecipe recipe;
  bool isSkinned = false;
  std::vector<double> placement;  // matrices of the joints, or of the node; empty: neither

  auto operator<=>(const MeshKey&) const = default;
};

// Does not keep meshes: it knows those that some scene has.
class MeshCache {
 public:
  // Null if no scene has the mesh.
  std::shared_ptr<const Mesh> find(const MeshKey& key) const {
    const auto found = meshes_.find(key);
    return found == meshes_.end() ? nullptr : found->second.lock();
  }
  void add(MeshKey key, const std::shared_ptr<const Mesh>& mesh) { meshes_[std::move(key)] = mesh; }
  void forgetUnused() {
    std::erase_if(meshes_, [](const auto& entry) { return entry.second.expired(); });
  }

 private:
  std::map<MeshKey, std::weak_ptr<const Mesh>> meshes_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A model file that carries transfer in attributes of its vertices.
#pragma once

#include <string>

#include "relight/light_basis.h"
#include "scene/gltf/custom_data.h"

namespace chromeball {

class TransferFile {
 public:
  static constexpr const char* kPrefix = "_PRT_";
  static std::string nameOf(size_t index) { return kPrefix + std::to_string(index); }

  // Reads the scene, extras.chromeball.basis and the attributes that start with kPrefix, as many as
  // the mesh has vertices. Throws InputError.
  TransferFile(const std::string& path, ExternalFiles external, const Warn& warn);

  const std::string& path() const { return path_; }
  const CustomData& data() const { return data_; }
  const LightBasis& basis() const { return basis_; }
  const Scene& scene() const { return scene_; }

  // By vertex of the instance's mesh. The second throws InputError where the first has null.
  const std::vector<vec3>* find(size_t instance, const std::string& name) const;
  const std::vector<vec3>& attribute(size_t instance, const std::string& name) const;

 private:
  const std::string& nodeName(size_t instance) const {
    return scene_.nodeNames[size_t(scene_.instances[instance].node)];
  }

  std::string path_;
  CustomData data_;
  LightBasis basis_;
  Scene scene_;
};

}  // namespace chromeball

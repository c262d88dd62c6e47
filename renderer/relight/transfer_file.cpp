// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer_file.h"

#include <fmt/format.h>

#include "base/error.h"

namespace chromeball {
namespace {

LightBasis basisOf(const CustomData& data, const std::string& path) {
  const auto name = data.texts.find("basis");
  if (name == data.texts.end() || data.attributes.empty())
    throwInput("{}: has no transfer ({}); `basis MODEL --at vertices` writes it", path,
               TransferFile::nameOf(0));
  return {name->second, path + ": extras.chromeball.basis"};
}

Scene sceneOf(const std::string& path, ExternalFiles external, const Warn& warn,
              const glm::dvec3& origin) {
  GltfChoice choice;
  choice.external = external;
  choice.origin = origin;
  choice.environment = false;
  return loadGltf(path, {}, warn, choice);
}

}  // namespace

TransferFile::TransferFile(const std::string& path, ExternalFiles external, const Warn& warn)
    : path_(path),
      data_(readCustomData(path, kPrefix, external)),
      basis_(basisOf(data_, path)),
      scene_(sceneOf(path, external, warn, data_.origin)) {
  if (scene_.instances.empty()) throwInput("{}: the model has no triangles", path);
  for (size_t i = 0; i < scene_.instances.size(); ++i) {
    const size_t vertices = scene_.meshes[size_t(scene_.instances[i].mesh)].positions.size();
    const auto arrays = data_.attributes.find(scene_.instances[i].node);
    if (arrays == data_.attributes.end()) continue;
    for (const auto& [name, array] : arrays->second)
      if (array.size() != vertices)
        throwInput("{}: node \"{}\": {} has {} elements for {} vertices of triangles", path,
                   nodeName(i), name, array.size(), vertices);
  }
}

const std::vector<vec3>* TransferFile::find(size_t instance, const std::string& name) const {
  const auto arrays = data_.attributes.find(scene_.instances[instance].node);
  if (arrays == data_.attributes.end()) return nullptr;
  const auto found = arrays->second.find(name);
  return found == arrays->second.end() ? nullptr : &found->second;
}

const std::vector<vec3>& TransferFile::attribute(size_t instance, const std::string& name) const {
  if (const std::vector<vec3>* found = find(instance, name)) return *found;
  throwInput("{}: node \"{}\" has no {}; {} has {} functions", path_, nodeName(instance), name,
             basis_.name(), basis_.size());
}

}  // namespace chromeball

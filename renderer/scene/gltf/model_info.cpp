// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/model_info.h"

#include <algorithm>
#include <set>

#include "scene/gltf/animation.h"
#include "scene/gltf/glb.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/material_reader.h"
#include "scene/gltf/model_cache.h"

namespace chromeball {
namespace {

using Info = ModelInfo;

// The nodes, children before their parents. (A file may nest them deeply: no recursion.)
std::vector<size_t> childrenFirst(const std::vector<int>& parents) {
  std::vector<int> open(parents.size(), 0);  // children that are not yet in the order
  for (const int parent : parents)
    if (parent >= 0) ++open[size_t(parent)];
  std::vector<size_t> order;
  for (size_t i = 0; i < parents.size(); ++i)
    if (open[i] == 0) order.push_back(i);
  for (size_t i = 0; i < order.size(); ++i)
    if (const int parent = parents[order[i]]; parent >= 0 && --open[size_t(parent)] == 0)
      order.push_back(size_t(parent));
  return order;
}

std::vector<Info::Node> nodesOf(const Scene& scene) {
  std::vector<int> parents = scene.nodeParents;
  parents.resize(scene.nodeNames.size(), -1);
  std::vector<Info::Node> nodes;
  for (size_t i = 0; i < parents.size(); ++i)
    nodes.push_back({.name = scene.nodeNames[i], .parent = parents[i], .depth = 0, .bounds = {}});
  for (const Instance& instance : scene.instances) {
    Info::Node& node = nodes[size_t(instance.node)];
    node.triangles += scene.meshes[size_t(instance.mesh)].triangles.size();
    node.bounds.add(bounds(scene, instance));
  }
  const std::vector<size_t> order = childrenFirst(parents);
  const auto parentOf = [&](size_t i) {
    return parents[i] < 0 ? nullptr : &nodes[size_t(parents[i])];
  };
  for (const size_t i : order)
    if (Info::Node* parent = parentOf(i)) {
      parent->triangles += nodes[i].triangles;
      parent->bounds.add(nodes[i].bounds);
    }
  for (size_t i = order.size(); i-- > 0;)
    if (const Info::Node* parent = parentOf(order[i])) nodes[order[i]].depth = parent->depth + 1;
  return nodes;
}

// The members of a material's extension that are textures.
int texturesIn(const tinygltf::Value& extension) {
  if (!extension.IsObject()) return 0;
  return int(std::ranges::count_if(extension.Keys(), [&](const std::string& key) {
    return memberOf(extension, key).Has("index");
  }));
}

Info::Material infoOf(const tinygltf::Material& material, size_t index) {
  const auto& pbr = material.pbrMetallicRoughness;
  Info::Material info{
      .name = material.name.empty() ? fmt::format("materials[{}]", index) : material.name,
      .extensions = {},
      .alphaMode = material.alphaMode,
      .isDoubleSided = material.doubleSided,
      .emits = std::ranges::any_of(material.emissiveFactor, [](double x) { return x > 0; }),
      .textures = 0};
  for (const int texture : {pbr.baseColorTexture.index, pbr.metallicRoughnessTexture.index,
                            material.normalTexture.index, material.occlusionTexture.index,
                            material.emissiveTexture.index})
    info.textures += texture >= 0;
  for (const auto& [name, extension] : material.extensions) {
    info.extensions.push_back(name);
    info.textures += texturesIn(extension);
  }
  return info;
}

Info::Animation infoOf(const GltfFile& file, size_t index) {
  const tinygltf::Animation& animation = file.model.animations[index];
  Info::Animation info{animationName(file.model.animations, index), 0, animation.channels.size()};
  for (const tinygltf::AnimationSampler& sampler : animation.samplers) {
    const auto& times = file.at(file.model.accessors, sampler.input, "accessors",
                                fmt::format("animations[{}]", index));
    if (!times.maxValues.empty()) info.seconds = std::max(info.seconds, times.maxValues[0]);
  }
  return info;
}

std::vector<Info::Extension> extensionsOf(const tinygltf::Model& model) {
  const std::set<std::string> required(model.extensionsRequired.begin(),
                                       model.extensionsRequired.end());
  std::vector<Info::Extension> extensions;
  for (const std::string& name : model.extensionsUsed)
    extensions.push_back({name, required.contains(name), isSupportedExtension(name)});
  return extensions;
}

}  // namespace

ModelInfo modelInfo(const std::string& path, ExternalFiles external) {
  ModelCache cache;
  cache.keepsFiles = true;
  ModelInfo info;
  info.scene =
      loadGltf(path, {}, [&](const std::string& warning) { info.warnings.push_back(warning); },
               {.external = external, .cache = &cache});
  const GltfFile& file = *cache.files.begin()->second;
  info.generator = file.model.asset.generator;
  info.nodes = nodesOf(info.scene);
  for (size_t i = 0; i < file.model.materials.size(); ++i)
    info.materials.push_back(infoOf(file.model.materials[i], i));
  for (const auto& [key, grid] : cache.texels.grids) {
    const std::string& uri = file.images[size_t(key.second)].uri;
    info.textures.push_back(
        {uri.empty() || isDataUri(uri) ? fmt::format("images[{}]", key.second) : decodePercent(uri),
         grid->width, grid->height, grid->byteCount()});
  }
  for (size_t i = 0; i < file.model.animations.size(); ++i)
    info.animations.push_back(infoOf(file, i));
  info.variants = variantNames(file);
  info.extensions = extensionsOf(file.model);
  return info;
}

}  // namespace chromeball

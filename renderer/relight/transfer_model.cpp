// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer_model.h"

#include <fmt/format.h>

#include "bake/vertex_geometry.h"
#include "base/error.h"

namespace chromeball {
namespace {

constexpr const char* kPrefix = "_PRT_";
constexpr const char* kOwn = "_PRT_OWN";

std::string attributeOf(size_t function) { return fmt::format("{}{}", kPrefix, function); }

LightBasis basisOf(const CustomData& data, const std::string& path) {
  const auto name = data.texts.find("basis");
  if (name == data.texts.end() || data.attributes.empty())
    throwInput("{}: has no transfer ({}); `basis MODEL --at vertices` writes it", path,
               attributeOf(0));
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

std::vector<BakedGeometry> transferGeometry(const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const VertexTransfer& transfer) {
  std::vector<BakedGeometry> all = vertexGeometry(meshes, points);
  size_t first = 0;
  for (BakedGeometry& geometry : all) {
    const size_t count = geometry.vertices.size();
    std::vector<uint8_t> isLit;
    for (size_t i = first; i < first + count; ++i) isLit.push_back(!transfer.isBuried[i]);
    const auto add = [&](const std::string& name, const auto& value) {
      std::vector<Rgb> column;
      column.reserve(count);
      for (size_t i = first; i < first + count; ++i) column.push_back(value(i));
      fillVertices(geometry.triangles, column, isLit);
      geometry.attributes.push_back({name, std::move(column)});
    };
    for (size_t k = 0; k < transfer.count; ++k)
      add(attributeOf(k), [&](size_t i) { return transfer.of(i)[k]; });
    if (!transfer.own.empty()) add(kOwn, [&](size_t i) { return transfer.own[i]; });
    first += count;
  }
  return all;
}

TransferModel::TransferModel(const std::string& path, ExternalFiles external, const Warn& warn)
    : path_(path),
      data_(readCustomData(path, kPrefix, external)),
      basis_(basisOf(data_, path)),
      scene_(sceneOf(path, external, warn, data_.origin)) {
  if (scene_.instances.empty()) throwInput("{}: the model has no triangles", path);
  checkAttributes();
}

void TransferModel::checkAttributes() const {
  for (size_t i = 0; i < scene_.instances.size(); ++i) {
    const CustomData::Arrays& arrays = arraysOf(i);
    const size_t vertices = scene_.meshes[size_t(scene_.instances[i].mesh)].positions.size();
    const std::string& node = scene_.nodeNames[size_t(scene_.instances[i].node)];
    for (size_t k = 0; k < basis_.size(); ++k)
      if (!arrays.contains(attributeOf(k)))
        throwInput("{}: node \"{}\" has no {}; {} has {} functions", path_, node, attributeOf(k),
                   basis_.name(), basis_.size());
    for (const auto& [name, array] : arrays)
      if (array.size() != vertices)
        throwInput("{}: node \"{}\": {} has {} elements for {} vertices of triangles", path_, node,
                   name, array.size(), vertices);
  }
}

const CustomData::Arrays& TransferModel::arraysOf(size_t instance) const {
  const int node = scene_.instances[instance].node;
  const auto found = data_.attributes.find(node);
  if (found == data_.attributes.end())
    throwInput("{}: node \"{}\" has no transfer ({})", path_, scene_.nodeNames[size_t(node)],
               attributeOf(0));
  return found->second;
}

TransferModel::Lit TransferModel::lit(const std::vector<BakePoint>& points,
                                      std::span<const Rgb> light) const {
  std::vector<std::vector<dvec3>> sums;
  for (size_t i = 0; i < scene_.instances.size(); ++i) {
    const CustomData::Arrays& arrays = arraysOf(i);
    std::vector<dvec3>& sum = sums.emplace_back(arrays.at(attributeOf(0)).size(), dvec3(0));
    const auto add = [&](const std::vector<vec3>& transfer, const dvec3& factor) {
      for (size_t v = 0; v < sum.size(); ++v) sum[v] += factor * dvec3(transfer[v]);
    };
    for (size_t k = 0; k < light.size(); ++k)
      if (light[k] != Rgb(0)) add(arrays.at(attributeOf(k)), dvec3(light[k]));
    if (const auto own = arrays.find(kOwn); own != arrays.end()) add(own->second, dvec3(1));
  }
  Lit lit;
  for (const BakePoint& point : points) {
    const dvec3& radiance = sums[size_t(point.instance)][point.x];
    const dvec3 raised = glm::max(radiance, dvec3(0));
    lit.negative += raised != radiance;
    const auto irradiance = Rgb(kPiD * raised);
    lit.light.points.push_back({{irradiance, irradiance}, false});
  }
  return lit;
}

}  // namespace chromeball

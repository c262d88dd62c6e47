// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/transfer_model.h"

#include <fmt/format.h>

#include "bake/vertex_light.h"
#include "base/error.h"

namespace chromeball {
namespace {

LightBasis basisOf(const CustomData& data, const std::string& path) {
  const auto name = data.texts.find("basis");
  if (name == data.texts.end() || data.attributes.empty())
    throwInput("{}: has no transfer ({}); `basis` at vertices writes it", path,
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

namespace {

constexpr const char* kOwnAttribute = "_PRT_OWN";

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
      add(TransferFile::nameOf(k), [&](size_t i) { return transfer.of(i)[k]; });
    if (!transfer.own.empty()) add(kOwnAttribute, [&](size_t i) { return transfer.own[i]; });
    first += count;
  }
  return all;
}

TransferLight lightOf(const TransferFile& file, const std::vector<BakePoint>& points,
                      std::span<const Rgb> light) {
  std::vector<std::vector<dvec3>> sums;
  for (size_t i = 0; i < file.scene().instances.size(); ++i) {
    std::vector<dvec3>& sum = sums.emplace_back();
    const auto add = [&](const std::vector<vec3>& transfer, const dvec3& factor) {
      sum.resize(transfer.size(), dvec3(0));
      for (size_t v = 0; v < sum.size(); ++v) sum[v] += factor * dvec3(transfer[v]);
    };
    for (size_t k = 0; k < light.size(); ++k) {
      const std::vector<vec3>& transfer = file.attribute(i, TransferFile::nameOf(k));
      if (k == 0 || light[k] != Rgb(0)) add(transfer, dvec3(light[k]));
    }
    if (const std::vector<vec3>* own = file.find(i, kOwnAttribute)) add(*own, dvec3(1));
  }
  TransferLight all;
  for (const BakePoint& point : points) addPoint(all, kPiD * sums[size_t(point.instance)][point.x]);
  return all;
}

void addPoint(TransferLight& all, const dvec3& light) {
  const dvec3 raised = glm::max(light, dvec3(0));
  all.negative += raised != light;
  all.light.points.push_back({{Rgb(raised), Rgb(raised)}, false});
}

}  // namespace chromeball

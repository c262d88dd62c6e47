// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer_model.h"

#include "bake/vertex_geometry.h"

namespace chromeball {
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

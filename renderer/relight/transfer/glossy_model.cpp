// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/glossy_model.h"

#include <fmt/format.h>

#include "bake/vertex_light.h"
#include "base/error.h"
#include "relight/transfer/transfer_points.h"

namespace chromeball {
namespace {

// A path from `view`, unit, away from the surface of a point.
EscapingPath pathFrom(const vec3& view, const PathTracer& tracer, const BakePoint& point,
                      const Surface& surface, PathContext& context) {
  PathState state = pathTo(surface, view, tracer, context);
  if (!tracer.vertex(state, hitOf(state, point), context))
    return {false, Rgb(0), vec3(0), state.radiance};
  return follow(tracer, state, context);
}

}  // namespace

GlossyTransfer estimateGlossyTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                      const std::vector<BakePoint>& points, const LightBasis& basis,
                                      const TransferSettings& settings, const Progress& progress) {
  const size_t columns = basis.size() + 1;
  GlossyTransfer result;
  VertexTransfer& matrices = result.matrices;
  matrices.count = ViewGrid::kCount * columns;
  matrices.values.assign(points.size() * matrices.count, Rgb(0));
  result.normals.assign(points.size(), vec3(0, 0, 1));
  const TransferPoints all(world, meshes, points, basis, settings);
  all.forPoints(matrices, progress, [&](size_t i, const Surface& surface, PointWorker& worker) {
    result.normals[i] = surface.normal;
    const Frame frame(surface.normal);
    for (int node = 0; node < ViewGrid::kCount; ++node) {
      const vec3 view = frame.toWorld(ViewGrid::direction(node));
      const std::span<Rgb> row =
          std::span(matrices.values).subspan(i * matrices.count + size_t(node) * columns, columns);
      all.setMean(
          i, worker,
          [&] { return pathFrom(view, all.tracer(), points[i], surface, worker.context); },
          row.first(basis.size()), row.back());
    }
  });
  return result;
}

namespace {

constexpr const char* kNormal = "_PRT_NORMAL";
constexpr const char* kMean = "mean";
constexpr float kBuried = -1;

std::string vectorName(size_t m) { return fmt::format("vector{}", m); }

// The scale of the scene's own light in the signals.
float ownScale(const VertexTransfer& matrices) {
  const size_t columns = matrices.count / ViewGrid::kCount;
  double own = 0, functions = 0;  // sums of squares
  for (size_t i = 0; i < matrices.values.size(); ++i) {
    const dvec3 value(matrices.values[i]);
    ((i + 1) % columns == 0 ? own : functions) += glm::dot(value, value);
  }
  return powerOfTwoNear(own > 0 ? std::sqrt(functions / double(columns - 1) / own) : 1);
}

// A table of the clusters: rows[c], or zeros where that is empty.
NamedArray tableOf(const std::string& name, const std::vector<std::span<const float>>& rows,
                   const VertexTransfer& matrices, float scaleOfOwn) {
  const size_t columns = matrices.count / ViewGrid::kCount;
  NamedArray table{name, {}};
  for (const std::span<const float> row : rows)
    for (size_t i = 0; i < matrices.count; ++i) {
      vec3 value(0);
      if (!row.empty()) value = {row[3 * i], row[3 * i + 1], row[3 * i + 2]};
      table.elements.push_back((i + 1) % columns == 0 ? value / scaleOfOwn : value);
    }
  return table;
}

// The numbers of a vertex: its cluster, then its weights.
float numberOf(const ClusteredPca& pca, size_t signal, size_t index) {
  if (index == 0) return float(pca.clusterOf[signal]);
  const std::vector<float>& weights = pca.weights[signal];
  return index <= weights.size() ? weights[index - 1] : 0;
}

size_t mostVectors(const ClusteredPca& pca) {
  size_t most = 0;
  for (const ClusteredPca::Cluster& cluster : pca.clusters)
    most = std::max(most, cluster.vectors.count());
  return most;
}

// The tables, multiplied by light: by table, the radiance of each cluster at each node.
class LitClusters {
 public:
  LitClusters(const TransferFile& file, std::span<const Rgb> light)
      : path_(file.path()), columns_(light.size() + 1) {
    const CustomData::Arrays& tables = file.data().tables;
    for (size_t t = 0; t < tables.size(); ++t) {
      const std::string name = t == 0 ? kMean : vectorName(t - 1);
      const auto table = tables.find(name);
      if (table == tables.end()) throwInput("{}: extras.chromeball.tables has no {}", path_, name);
      radiances_.push_back(lit(table->second, light));
      if (const size_t cluster = ViewGrid::kCount * columns_;
          table->second.empty() || table->second.size() % cluster != 0 ||
          radiances_.back().size() != radiances_.front().size())
        throwInput("{}: {}: {} elements are not those of clusters of {} x {}", path_, name,
                   table->second.size(), ViewGrid::kCount, columns_);
    }
  }

  size_t tables() const { return radiances_.size(); }
  size_t clusters() const { return radiances_.front().size() / ViewGrid::kCount; }

  dvec3 at(size_t table, size_t cluster, const ViewGrid::Weights& view) const {
    dvec3 sum(0);
    for (size_t i = 0; i < 4; ++i)
      sum += double(view.weights[i]) *
             radiances_[table][cluster * ViewGrid::kCount + size_t(view.nodes[i])];
    return sum;
  }

 private:
  std::vector<dvec3> lit(const std::vector<vec3>& table, std::span<const Rgb> light) const {
    std::vector<dvec3> rows;
    for (size_t first = 0; first + columns_ <= table.size(); first += columns_) {
      dvec3 sum(table[first + light.size()]);  // the scene's own
      for (size_t k = 0; k < light.size(); ++k) sum += dvec3(light[k]) * dvec3(table[first + k]);
      rows.push_back(sum);
    }
    return rows;
  }

  std::string path_;
  size_t columns_;
  std::vector<std::vector<dvec3>> radiances_;
};

}  // namespace

Signals signalsOf(const GlossyTransfer& transfer) {
  const VertexTransfer& matrices = transfer.matrices;
  const size_t columns = matrices.count / ViewGrid::kCount;
  const float scale = ownScale(matrices);
  Signals signals{3 * matrices.count, {}};
  for (size_t i = 0; i < matrices.isBuried.size(); ++i) {
    if (matrices.isBuried[i]) continue;
    const std::span<const Rgb> values = matrices.of(i);
    for (size_t k = 0; k < values.size(); ++k) {
      const Rgb value = (k + 1) % columns == 0 ? scale * values[k] : values[k];
      signals.values.insert(signals.values.end(), {value.x, value.y, value.z});
    }
  }
  return signals;
}

GlossyFile glossyFile(const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                      const GlossyTransfer& transfer, const ClusteredPca& pca) {
  const size_t most = mostVectors(pca), attributes = (1 + most + 2) / 3;
  GlossyFile file{vertexGeometry(meshes, points), {}};
  size_t point = 0, signal = 0;
  for (BakedGeometry& geometry : file.geometry) {
    geometry.attributes.push_back({kNormal, {}});
    for (size_t a = 0; a < attributes; ++a)
      geometry.attributes.push_back({TransferFile::nameOf(a), {}});
    for (size_t v = 0; v < geometry.vertices.size(); ++v, ++point) {
      const bool isBuried = transfer.matrices.isBuried[point] != 0;
      geometry.attributes[0].elements.push_back(transfer.normals[point]);
      for (size_t a = 0; a < attributes; ++a) {
        vec3 numbers(a == 0 ? kBuried : 0, 0, 0);
        for (int c = 0; !isBuried && c < 3; ++c)
          numbers[c] = numberOf(pca, signal, 3 * a + size_t(c));
        geometry.attributes[1 + a].elements.push_back(numbers);
      }
      signal += !isBuried;
    }
  }
  const float scale = ownScale(transfer.matrices);
  for (size_t t = 0; t <= most; ++t) {
    std::vector<std::span<const float>> rows;
    for (const auto& [mean, vectors] : pca.clusters)
      rows.push_back(t == 0                 ? std::span(mean)
                     : t <= vectors.count() ? vectors[t - 1]
                                            : std::span<const float>());
    file.tables.push_back(
        tableOf(t == 0 ? kMean : vectorName(t - 1), rows, transfer.matrices, scale));
  }
  return file;
}

bool isGlossy(const TransferFile& file) { return file.data().tables.contains(kMean); }

TransferLight lightTowards(const TransferFile& file, const std::vector<PlacedMesh>& meshes,
                           const std::vector<BakePoint>& points, std::span<const Rgb> light,
                           const glm::dvec3& eye) {
  const LitClusters clusters(file, light);
  TransferLight all;
  for (const BakePoint& point : points) {
    const auto instance = size_t(point.instance);
    const auto number = [&](size_t index) {
      return double(
          file.attribute(instance, TransferFile::nameOf(index / 3))[point.x][int(index % 3)]);
    };
    const double cluster = number(0);
    if (cluster == double(kBuried)) {
      all.light.points.push_back({{}, true});
      continue;
    }
    if (!(cluster >= 0 && cluster < double(clusters.clusters())) || cluster != std::floor(cluster))
      throwInput("{}: {}: vertex {}: {} is not a cluster, 0 to {}", file.path(),
                 TransferFile::nameOf(0), point.x, cluster, clusters.clusters() - 1);
    const Frame frame(file.attribute(instance, kNormal)[point.x]);
    const glm::dvec3 towards = unitOrZero(eye - glm::dvec3(meshes[instance].positions[point.x]));
    const bool isApart = towards != glm::dvec3(0);
    const auto view = ViewGrid::at(isApart ? frame.toLocal(vec3(towards)) : vec3(0, 0, 1));
    dvec3 radiance = clusters.at(0, size_t(cluster), view);
    for (size_t t = 1; t < clusters.tables(); ++t)
      radiance += number(t) * clusters.at(t, size_t(cluster), view);
    addPoint(all, radiance);
  }
  return all;
}

}  // namespace chromeball

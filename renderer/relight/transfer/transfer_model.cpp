// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/transfer_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "bake/vertex_light.h"
#include "base/error.h"
#include "relight/transfer/transfer_points.h"

namespace chromeball {
namespace {

constexpr const char* kOwnAttribute = "_PRT_OWN";

// "haar:16" is the transform of "cube:16".
DirectionBasis directionsOf(const std::string& name, const std::string& location) {
  const auto is = [&](const char* kind, int number) {
    return name == fmt::format("{}:{}", kind, number);
  };
  for (int order = 0; order <= LightBasis::kMaxOrder; ++order)
    if (is("sh", order)) return {name, location};
  for (int cells = 1; cells <= LightBasis::kMaxCells; cells *= 2)
    if (is("haar", cells)) return {fmt::format("cube:{}", cells), location};
  throwInput("{}: `{}` is not sh:ORDER, of order 0 to {}, or haar:N, N a power of two from 1 to {}",
             location, name, LightBasis::kMaxOrder, LightBasis::kMaxCells);
}

// A path from the front of a white Lambertian surface.
EscapingPath pathFromWhite(const PathTracer& tracer, const Surface& surface, PathContext& context) {
  PathState state = pathTo(surface, surface.normal, tracer, context);
  const MaterialPoint white{Rgb(1), 0, 1, Rgb(0), 0};
  const Bsdf bsdf(white, surface, surface.normal, tracer.world().bsdfTables);
  if (!tracer.scatter(state, surface, bsdf, context))
    return {false, Rgb(0), vec3(0), state.radiance};
  return follow(tracer, state, context);
}

}  // namespace

LightBasis::LightBasis(const std::string& name, const std::string& location)
    : name_(name),
      directions_(directionsOf(name, location)),
      domain_(directions_.hasCells() ? RelightDomain::Haar : RelightDomain::Sh) {}

std::vector<Rgb> LightBasis::project(const Image& latLong, const Rotation& rotation) const {
  std::vector<Rgb> light = lightWeights(directions_, latLong, rotation);
  transform(light);
  return light;
}

double LightBasis::support(size_t function) const {
  if (!isHaar()) return 1;
  const auto n = size_t(directions_.columns());
  const size_t largest = std::max(function % n, function / n % n);
  const auto blocks = double(std::bit_floor(std::max<size_t>(largest, 1)));  // along an edge
  return 1 / (blocks * blocks);
}

void keepMostImportant(const LightBasis& basis, size_t keep, std::span<Rgb> light) {
  std::vector<size_t> order(light.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto importance = [&](size_t i) { return glm::length(dvec3(light[i])) * basis.support(i); };
  std::ranges::stable_sort(order,
                           [&](size_t a, size_t b) { return importance(a) > importance(b); });
  for (size_t i = keep; i < order.size(); ++i) light[order[i]] = Rgb(0);
}

VertexTransfer estimateTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                const std::vector<BakePoint>& points, const LightBasis& basis,
                                const TransferSettings& settings, const Progress& progress) {
  VertexTransfer result;
  result.count = basis.size();
  result.values.assign(points.size() * result.count, Rgb(0));
  std::vector<Rgb> own(points.size(), Rgb(0));
  const TransferPoints all(world, meshes, points, basis, settings);
  all.forPoints(result, progress, [&](size_t i, const Surface& surface, PointWorker& worker) {
    all.setMean(
        i, worker, [&] { return pathFromWhite(all.tracer(), surface, worker.context); },
        std::span(result.values).subspan(i * result.count, result.count), own[i]);
  });
  if (std::ranges::any_of(own, [](const Rgb& light) { return light != Rgb(0); }))
    result.own = std::move(own);
  return result;
}

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
    if (data_.turned.contains(scene_.instances[i].node))
      throwInput(
          "{}: node \"{}\" is turned or mirrored, but its transfer is for light of fixed "
          "directions; turn the model before `basis`, or the light (--probe-rotation)",
          path, nodeName(i));
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

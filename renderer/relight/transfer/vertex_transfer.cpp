// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/vertex_transfer.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/error.h"
#include "relight/transfer/transfer_points.h"

namespace chromeball {
namespace {

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

namespace {

// A path from the front of a white Lambertian surface.
EscapingPath pathFromWhite(const PathTracer& tracer, const Surface& surface, PathContext& context) {
  PathState state;
  state.ray = {surface.position + surface.normal, -surface.normal};
  const MaterialPoint white{Rgb(1), 0, 1, Rgb(0), 0};
  const Bsdf bsdf(white, surface, surface.normal, tracer.world().bsdfTables);
  if (!tracer.scatter(state, surface, bsdf, context))
    return {false, Rgb(0), vec3(0), state.radiance};
  return follow(tracer, state, context);
}

}  // namespace

VertexTransfer estimateTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                const std::vector<BakePoint>& points, const LightBasis& basis,
                                const TransferSettings& settings, const Progress& progress) {
  const NoProbe dark;
  const PathTracer tracer(world, dark, {.maxDepth = settings.maxDepth, .estimateDepthCut = false});
  VertexTransfer result;
  result.count = basis.size();
  result.values.assign(points.size() * result.count, Rgb(0));
  std::vector<Rgb> own(points.size(), Rgb(0));
  const TransferPoints all(tracer, meshes, points, settings);
  all.forPoints(result, progress, [&](size_t i, const Surface& surface, TransferWorker& worker) {
    worker.sums.assign(result.count, dvec3(0));
    dvec3 found(0);
    const uint32_t valid = all.forSamples(
        i, worker, [&] { return pathFromWhite(tracer, surface, worker.context); },
        [&](const EscapingPath& path) {
          if (path.escapes) basis.add(path.direction, dvec3(path.throughput), worker.sums);
          found += dvec3(path.found);
        });
    if (valid == 0) return;
    const std::span<Rgb> values = std::span(result.values).subspan(i * result.count, result.count);
    for (size_t k = 0; k < result.count; ++k) values[k] = Rgb(worker.sums[k] / double(valid));
    basis.transform(values);
    own[i] = Rgb(found / double(valid));
  });
  if (std::ranges::any_of(own, [](const Rgb& light) { return light != Rgb(0); }))
    result.own = std::move(own);
  world.scene.checkTexels();
  return result;
}

}  // namespace chromeball

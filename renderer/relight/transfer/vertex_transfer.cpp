// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/vertex_transfer.h"

#include <algorithm>

#include "relight/transfer/transfer_points.h"

namespace chromeball {
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

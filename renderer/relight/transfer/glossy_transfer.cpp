// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/glossy_transfer.h"

#include "relight/transfer/transfer_points.h"

namespace chromeball {
namespace {

// A path from `view`, unit, away from the surface of a point.
EscapingPath pathFrom(const vec3& view, const PathTracer& tracer, const BakePoint& point,
                      const Surface& surface, PathContext& context) {
  PathState state;
  state.ray = {surface.position + view, -view};
  const Hit hit{uint32_t(point.instance), point.triangle, point.barycentric, 1};
  if (!tracer.vertex(state, hit, context)) return {false, Rgb(0), vec3(0), state.radiance};
  return follow(tracer, state, context);
}

}  // namespace

GlossyTransfer estimateGlossyTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                      const std::vector<BakePoint>& points, const LightBasis& basis,
                                      const TransferSettings& settings, const Progress& progress) {
  const NoProbe dark;
  const PathTracer tracer(world, dark, {.maxDepth = settings.maxDepth, .estimateDepthCut = false});
  const size_t columns = basis.size() + 1;
  GlossyTransfer result;
  VertexTransfer& matrices = result.matrices;
  matrices.count = ViewGrid::kCount * columns;
  matrices.values.assign(points.size() * matrices.count, Rgb(0));
  result.normals.assign(points.size(), vec3(0, 0, 1));
  const TransferPoints all(tracer, meshes, points, settings);
  all.forPoints(matrices, progress, [&](size_t i, const Surface& surface, TransferWorker& worker) {
    result.normals[i] = surface.normal;
    const Frame frame(surface.normal);
    for (int node = 0; node < ViewGrid::kCount; ++node) {
      const vec3 view = frame.toWorld(ViewGrid::direction(node));
      worker.sums.assign(basis.size(), dvec3(0));
      dvec3 found(0);
      const uint32_t valid = all.forSamples(
          i, worker, [&] { return pathFrom(view, tracer, points[i], surface, worker.context); },
          [&](const EscapingPath& path) {
            if (path.escapes) basis.add(path.direction, dvec3(path.throughput), worker.sums);
            found += dvec3(path.found);
          });
      if (valid == 0) continue;
      const std::span<Rgb> row =
          std::span(matrices.values).subspan(i * matrices.count + size_t(node) * columns, columns);
      for (size_t k = 0; k < basis.size(); ++k) row[k] = Rgb(worker.sums[k] / double(valid));
      basis.transform(row.first(basis.size()));
      row.back() = Rgb(found / double(valid));
    }
  });
  world.scene.checkTexels();
  return result;
}

}  // namespace chromeball

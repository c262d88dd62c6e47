// SPDX-License-Identifier: Apache-2.0
#include "bake/bake.h"

#include <atomic>
#include <bit>
#include <mutex>

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr uint32_t kMaxTable = 4096;       // points; more samples take another randomisation
constexpr uint64_t kProbingBlock = ~0ull;  // of the sampler, for isBuried()

struct Worker {
  PathContext context;
  InvalidSamples invalid;
};

class Baker {
 public:
  Baker(const PathTracer& tracer, const std::vector<PlacedMesh>& meshes,
        const BakeSettings& settings)
      : light_(tracer, settings.what, settings.distance),
        meshes_(meshes),
        settings_(settings),
        table_(std::bit_ceil(std::clamp((settings.samples + 1) / 2, 16u, kMaxTable)),
               dimension::tabulated(settings.maxDepth + 1), settings.seed) {}

  Worker makeWorker() const {
    return {{.sampler = PixelSampler(table_, settings_.seed), .clamp = Clamp()}, {}};
  }

  PointResult bake(const BakePoint& point, Worker& worker) const {
    PointResult result;
    PathContext& context = worker.context;
    const Surface surface = light_.surfaceAt(point);
    context.sampler.startPixel(point.x, point.y, kProbingBlock);
    result.buried = light_.isBuried(point, surface, meshes_, context);
    if (result.buried) return result;
    for (uint32_t half = 0; half < 2; ++half) {
      glm::dvec3 sum(0);
      uint32_t valid = 0;
      for (uint32_t i = 0; i < (settings_.samples + 1 - half) / 2; ++i) {
        if (i % table_.size() == 0)
          context.sampler.startPixel(point.x, point.y, 2 * uint64_t(i / table_.size()) + half);
        context.sampler.startSample(i % table_.size());
        const Rgb found = light_.sample(point, surface, context);
        if (const auto defect = defectOf(found, false)) {
          worker.invalid.add(*defect, int(point.x), int(point.y));
          continue;
        }
        sum += glm::dvec3(found);
        ++valid;
      }
      if (valid > 0) result.halves[half] = Rgb(sum / double(valid));
    }
    return result;
  }

 private:
  PointLight light_;
  const std::vector<PlacedMesh>& meshes_;
  const BakeSettings& settings_;
  SobolTable table_;
};

}  // namespace

BakeResult bake(const World& world, const LightSource& lighting,
                const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                const BakeSettings& settings, const Progress& progress) {
  const PathTracer tracer(world, lighting,
                          {.maxDepth = settings.maxDepth, .estimateDepthCut = false});
  const Baker baker(tracer, meshes, settings);
  BakeResult result;
  result.points.resize(points.size());
  PerThread<Worker> workers([&] { return baker.makeWorker(); });
  std::atomic<size_t> finished = 0;
  std::mutex reporting;
  constexpr size_t kGrain = 64;
  parallelRanges(points.size(), kGrain, [&](size_t begin, size_t end) {
    Worker& worker = workers.local();
    for (size_t i = begin; i < end; ++i) result.points[i] = baker.bake(points[i], worker);
    const size_t count = finished += end - begin;
    if (std::unique_lock lock(reporting, std::try_to_lock); lock)
      progress(double(count) / double(points.size()));
  });
  workers.forEach([&](const Worker& worker) {
    result.invalid.add(worker.invalid);
    result.rays.add(worker.context.counts);
  });
  world.scene.checkTexels();
  return result;
}

}  // namespace chromeball

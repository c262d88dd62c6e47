// SPDX-License-Identifier: Apache-2.0
// Calls an estimate at every point of a scene, on all threads.
#pragma once

#include <atomic>
#include <bit>
#include <mutex>

#include "bake/bake.h"
#include "base/parallel.h"
#include "relight/transfer/transfer_model.h"
#include "transport/path.h"

namespace chromeball {

// Paths that look for light of every direction at once.

// A probe whose light no path adds: the caller decides what an escaping path finds.
class NoProbe : public LightSource {
 public:
  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
};

// A path adds throughput x (radiance from the direction) if the probe is open to it.
struct EscapingPath {
  bool escapes = false;
  Rgb throughput{0};
  vec3 direction{0};
  Rgb found{0};  // of the scene's own lamps and emission
};

// Follows a path up to where it ends. `tracer`: its lighting is a NoProbe.
inline EscapingPath follow(const PathTracer& tracer, PathState state, PathContext& context) {
  for (;;) {
    context.sampler.startVertex(state.depth);
    const std::optional<Hit> hit = tracer.nextHit(state, context);
    const bool goesOn = tracer.vertex(state, hit, context);
    if (!hit) return {true, state.throughput, state.ray.direction, state.radiance};
    if (!goesOn) return {false, Rgb(0), vec3(0), state.radiance};
  }
}

// The scratch of a thread.
struct TransferWorker {
  PathContext context;
  InvalidSamples invalid;
  std::vector<dvec3> sums;
};

// The random numbers of all points, and the loop over their samples. `tracer`: its lighting is a
// NoProbe.
class TransferPoints {
 public:
  TransferPoints(const PathTracer& tracer, const std::vector<PlacedMesh>& meshes,
                 const std::vector<BakePoint>& points, const TransferSettings& settings)
      : light_(tracer, BakedLight::Irradiance, INFINITY),
        meshes_(meshes),
        points_(points),
        settings_(settings),
        table_(std::bit_ceil(std::clamp(settings.samples, 16u, kMaxTable)),
               dimension::tabulated(settings.maxDepth + 1), settings.seed) {}

  // Calls estimate(point, surface, worker), which may call forSamples(), for each point that is not
  // buried; `result` gets the rest.
  template <class Estimate>
  void forPoints(VertexTransfer& result, const Progress& progress, const Estimate& estimate) const {
    result.isBuried.assign(points_.size(), 0);
    PerThread<TransferWorker> workers([&] {
      return TransferWorker{
          {.sampler = PixelSampler(table_, settings_.seed), .clamp = Clamp()}, {}, {}};
    });
    std::atomic<size_t> finished = 0;
    std::mutex reporting;
    constexpr size_t kGrain = 16;
    parallelRanges(points_.size(), kGrain, [&](size_t begin, size_t end) {
      TransferWorker& worker = workers.local();
      for (size_t i = begin; i < end; ++i) {
        const BakePoint& point = points_[i];
        const Surface surface = light_.surfaceAt(point);
        worker.context.sampler.startPixel(point.x, point.y, kProbingBlock);
        result.isBuried[i] = light_.isBuried(point, surface, meshes_, worker.context);
        if (!result.isBuried[i]) estimate(i, surface, worker);
      }
      const size_t count = finished += end - begin;
      if (std::unique_lock lock(reporting, std::try_to_lock); lock)
        progress(double(count) / double(points_.size()));
    });
    workers.forEach([&](const TransferWorker& worker) { result.invalid.add(worker.invalid); });
  }

  // Calls add(trace()) for each sample, with its random numbers set, except for invalid paths.
  // Returns how many are valid.
  template <class Trace, class Add>
  uint32_t forSamples(size_t index, TransferWorker& worker, const Trace& trace,
                      const Add& add) const {
    const BakePoint& point = points_[index];
    PixelSampler& sampler = worker.context.sampler;
    uint32_t valid = 0;
    for (uint32_t i = 0; i < settings_.samples; ++i) {
      if (i % table_.size() == 0) sampler.startPixel(point.x, point.y, i / table_.size());
      sampler.startSample(i % table_.size());
      sampler.startVertex(0);
      ++worker.context.counts.camera;
      const EscapingPath path = trace();
      if (const auto defect = defectOf(path.throughput + path.found, false)) {
        worker.invalid.add(*defect, int(point.x), int(point.y));
        continue;
      }
      add(path);
      ++valid;
    }
    return valid;
  }

 private:
  static constexpr uint32_t kMaxTable = 4096;  // points; more samples take another randomisation
  static constexpr uint64_t kProbingBlock = ~0ull;  // of the sampler, for isBuried()

  PointLight light_;
  const std::vector<PlacedMesh>& meshes_;
  const std::vector<BakePoint>& points_;
  const TransferSettings& settings_;
  SobolTable table_;
};

}  // namespace chromeball

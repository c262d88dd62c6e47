// SPDX-License-Identifier: Apache-2.0
// Transfer at points of a scene, by paths that look for light of every direction at once.
#pragma once

#include "bake/bake.h"
#include "relight/transfer/transfer_model.h"
#include "transport/path.h"

namespace chromeball {

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

// The transfer of points: a bake of paths in a world whose probe is dark.
class TransferPoints {
 public:
  // All arguments must outlive this.
  TransferPoints(const World& world, const std::vector<PlacedMesh>& meshes,
                 const std::vector<BakePoint>& points, const LightBasis& basis,
                 const TransferSettings& settings)
      : tracer_(world, dark_, {.maxDepth = settings.maxDepth, .estimateDepthCut = false}),
        light_(tracer_, BakedLight::Irradiance, INFINITY),
        samples_(light_, meshes, points, settings.samples, settings.maxDepth, settings.seed),
        count_(settings.samples),
        basis_(basis) {}

  const PathTracer& tracer() const { return tracer_; }

  // Calls estimate(point, surface, worker), which may call setMean(), for each point that is not
  // buried; `result` gets the rest.
  void forPoints(VertexTransfer& result, const Progress& progress,
                 const PointSamples::Estimate& estimate) const {
    PointSamples::Totals totals = samples_.forPoints(estimate, progress);
    result.isBuried = std::move(totals.isBuried);
    result.invalid = totals.invalid;
  }

  // Sets the mean of all valid paths that trace() makes, if there is one: their transfer, and the
  // light of the scene's own lamps.
  void setMean(size_t point, PointWorker& worker, const std::function<EscapingPath()>& trace,
               std::span<Rgb> transfer, Rgb& own) const {
    std::vector<dvec3> sums(basis_.size(), dvec3(0));
    dvec3 found(0);
    EscapingPath path;
    const auto sample = [&] {
      worker.context.sampler.startVertex(0);
      ++worker.context.counts.camera;
      path = trace();
      return path.throughput + path.found;
    };
    const auto add = [&](const Rgb&) {
      if (path.escapes) basis_.add(path.direction, dvec3(path.throughput), sums);
      found += dvec3(path.found);
    };
    const uint32_t valid = samples_.forSamples(point, count_, 0, 1, worker, sample, add);
    if (valid == 0) return;
    for (size_t k = 0; k < sums.size(); ++k) transfer[k] = Rgb(sums[k] / double(valid));
    basis_.transform(transfer);
    own = Rgb(found / double(valid));
  }

 private:
  NoProbe dark_;
  PathTracer tracer_;
  PointLight light_;
  PointSamples samples_;
  uint32_t count_;  // paths of a mean
  const LightBasis& basis_;
};

}  // namespace chromeball

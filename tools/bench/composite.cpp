// SPDX-License-Identifier: Apache-2.0
// The cost of differential rendering relative to one plain render of the whole scene, alternating,
// both with one thread: the still life on its table, with the table as the local scene.
#include "composite/differential.h"
#include "scene.h"

namespace chromeball {
namespace {

void differential(benchmark::State& state, demo::Finish finish) {
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  ObjectMask isObject;
  for (const Instance& instance : s.scene.instances)
    isObject.push_back(s.scene.nodeNames[size_t(instance.node)] != "table");
  const World world(s.scene, rayMasks(isObject));
  const CompositeWorlds worlds(world, *s.lighting, {.maxDepth = kDepth});
  const Camera& camera = s.scene.cameras.front();

  double plain = 0, both = 0;
  Rgb plainSum(0), withObjects(0);
  for (auto _ : state) {
    const double start = cpuSeconds();
    plainSum =
        sumOverSamples(camera, world, [&](const CameraSamples& cameras, PathContext& context) {
          const std::span<const Rgb> radiances = PathBatch::traced(cameras, worlds.whole, context);
          Rgb sum(0);
          for (size_t i = 0; i < cameras.size(); ++i) sum += radiances[i];
          return sum;
        });
    const double middle = cpuSeconds();
    withObjects =
        sumOverSamples(camera, world, [&](const CameraSamples& cameras, PathContext& context) {
          std::array<DifferentialSample, kTraced> found;
          differentialRadiance(worlds, cameras, false, context, found);
          Rgb sum(0);
          for (size_t i = 0; i < cameras.size(); ++i) sum += found[i].both + found[i].withObjects;
          return sum;
        });
    plain += middle - start;
    both += cpuSeconds() - middle;
  }
  if (std::fabs(luminance(withObjects) / luminance(plainSum) - 1) > 1e-3)
    state.SkipWithError("L_obj is not what the plain render makes of it");
  state.counters["cost over a plain render"] = both / plain;
}
BENCHMARK_CAPTURE(differential, lambertian, demo::Finish::Lambertian)->Apply(inMilliseconds);
BENCHMARK_CAPTURE(differential, conductors, demo::Finish::Conductors)->Apply(inMilliseconds);

}  // namespace
}  // namespace chromeball

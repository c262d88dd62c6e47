// SPDX-License-Identifier: Apache-2.0
// What differential rendering costs beside one plain render of the whole scene, both of one thread
// and in turn: the still life on its table, the table being the local scene.
#include <benchmark/benchmark.h>

#include "composite/differential_path.h"
#include "scene.h"

namespace chromeball {
namespace {

void differential(benchmark::State& state, demo::Finish finish) {
  constexpr int kTraced = 16;
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  ObjectMask isObject, isLocal;
  for (const Instance& instance : s.scene.instances)
    isObject.push_back(s.scene.nodeNames[size_t(instance.node)] != "table");
  isLocal = isObject;
  isLocal.flip();
  const Accel local(s.scene, isLocal);
  const LocalRays rays{local, isObject};
  const DifferentialScene worlds{
      {s.scene, s.accel, *s.lighting, s.emitters.get(), Mis::Balance, kDepth, true},
      {s.scene, rays, *s.lighting, s.emitters.get(), Mis::Balance, kDepth, true},
      isObject,
      false};
  const Camera& camera = s.scene.cameras.front();

  std::vector<DirectionSample> scratch;
  RayCounts counts;
  const SobolTable unused(1, 4, 0);
  PathMemory memory{PixelSampler(unused, 0), {}, {}, {}};
  double plain = 0, both = 0;
  Rgb plainSum(0), withObjects(0);
  for (auto _ : state) {
    const double start = cpuSeconds();
    plainSum = sumOverPicture(camera, kTraced, [&](const Ray& ray, PixelSampler& sampler) {
      return pathRadiance(worlds.whole, PathState{ray}, closestHit(s.accel, ray, sampler), sampler,
                          scratch, counts, nullptr);
    });
    const double middle = cpuSeconds();
    withObjects = sumOverPicture(camera, kTraced, [&](const Ray& ray, PixelSampler& sampler) {
      memory.sampler = sampler;
      const DifferentialSample sample = differentialRadiance(
          worlds, {0, 0, ray, closestHit(s.accel, ray, sampler)}, memory, nullptr);
      return sample.both + sample.withObjects;
    });
    plain += middle - start;
    both += cpuSeconds() - middle;
  }
  if (std::fabs(luminance(withObjects) / luminance(plainSum) - 1) > 1e-3)
    state.SkipWithError("L_obj is not what the plain render makes of it");
  state.counters["cost over a plain render"] = both / plain;
}
BENCHMARK_CAPTURE(differential, lambertian, demo::Finish::Lambertian)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(differential, conductors, demo::Finish::Conductors)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace chromeball

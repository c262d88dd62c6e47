// SPDX-License-Identifier: Apache-2.0
// What a render costs beside its rays: samples and rays a second, and the time of the same rays
// replayed by Embree alone. CHROMEBALL_PROBE names another probe than the project's own studio.
#include <benchmark/benchmark.h>

#include "integrate/render.h"
#include "scene.h"

BENCHMARK_MAIN();

namespace chromeball {
namespace {

// Answers as Accel does, and remembers what it was asked.
struct Recorder {
  struct Query {
    Ray ray;
    bool shadow;
  };
  const Accel& accel;
  mutable std::vector<Query> queries;

  bool intersect(const Ray& ray, uint32_t key, Hit& hit) const {
    queries.push_back({ray, false});
    return accel.intersect(ray, key, hit);
  }
  Rgb transmittance(const Ray& ray) const {
    queries.push_back({ray, true});
    return accel.transmittance(ray);
  }
};

// One thread's paths over the picture, `samples` a pixel.
template <class Rays>
Rgb tracePicture(const BenchmarkScene& s, const Rays& rays, int samples) {
  const PathScene<Rays> path{s.scene, rays, *s.lighting, s.emitters.get(), Mis::Balance, kDepth};
  std::vector<DirectionSample> scratch;
  RayCounts counts;
  return sumOverPicture(s.scene.cameras.front(), samples,
                        [&](const Ray& ray, PixelSampler& sampler) {
                          return pathRadiance(path, PathState{ray}, closestHit(rays, ray, sampler),
                                              sampler, scratch, counts, nullptr);
                        });
}

void render(benchmark::State& state, demo::Finish finish) {
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  RenderSettings settings;
  settings.width = kWidth, settings.height = kHeight, settings.samples = kSamples;
  settings.maxDepth = kDepth;
  const std::atomic<bool> stop = false;
  double samples = 0, rays = 0;
  for (auto _ : state) {
    const RenderResult r = chromeball::render(
        s.scene, s.accel, s.scene.cameras.front(), *s.lighting, settings, [](double) {}, stop);
    samples += double(r.rays.camera);
    rays += double(r.rays.camera + r.rays.shadow + r.rays.bounce);
    settings.seed++;
  }
  using benchmark::Counter;
  state.counters["samples/s"] = Counter(samples, Counter::kIsRate);
  state.counters["rays/s"] = Counter(rays, Counter::kIsRate);
  state.counters["rays/sample"] = rays / samples;
}

// Render time over the time of the same rays alone, both of one thread and in turn.
void overhead(benchmark::State& state, demo::Finish finish) {
  constexpr int kTraced = 16;
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  const Recorder recorder{s.accel, {}};
  benchmark::DoNotOptimize(tracePicture(s, recorder, kTraced));
  double whole = 0, alone = 0;
  for (auto _ : state) {
    const double start = cpuSeconds();
    benchmark::DoNotOptimize(tracePicture(s, s.accel, kTraced));
    const double middle = cpuSeconds();
    for (const Recorder::Query& query : recorder.queries) {
      Hit hit;
      if (query.shadow)
        benchmark::DoNotOptimize(s.accel.transmittance(query.ray));
      else
        benchmark::DoNotOptimize(s.accel.intersect(query.ray, 0, hit));
    }
    const double end = cpuSeconds();
    whole += middle - start;
    alone += end - middle;
  }
  const double samples = double(state.iterations()) * kWidth * kHeight * kTraced;
  state.counters["ratio"] = whole / alone;
  state.counters["ns/sample"] = 1e9 * whole / samples;
  state.counters["ns/sample in Embree"] = 1e9 * alone / samples;
}

BENCHMARK_CAPTURE(render, lambertian, demo::Finish::Lambertian)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(render, conductors, demo::Finish::Conductors)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(overhead, lambertian, demo::Finish::Lambertian)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(overhead, conductors, demo::Finish::Conductors)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The overhead of a render over ray tracing: samples and rays per second, and the time of the same
// rays replayed by Embree alone. CHROMEBALL_PROBE replaces the default probe, a studio.
#include "render/render.h"
#include "scene.h"

BENCHMARK_MAIN();

namespace chromeball {
namespace {

void render(benchmark::State& state, demo::Finish finish) {
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  RenderSettings settings;
  settings.width = kWidth, settings.height = kHeight, settings.samples = kSamples;
  settings.maxDepth = kDepth;
  const std::atomic<bool> stop = false;
  double samples = 0, rays = 0;
  for (auto _ : state) {
    const RenderResult r = chromeball::render(
        s.world, s.scene.cameras.front(), *s.lighting, settings, [](double) {}, stop);
    samples += double(r.rays.camera);
    rays += double(r.rays.camera + r.rays.shadow + r.rays.bounce);
    settings.seed++;
  }
  using benchmark::Counter;
  state.counters["samples/s"] = Counter(samples, Counter::kIsRate);
  state.counters["rays/s"] = Counter(rays, Counter::kIsRate);
  state.counters["rays/sample"] = rays / samples;
}

// Render time over the time of the same rays alone, alternating, both with one thread.
void overhead(benchmark::State& state, demo::Finish finish) {
  const BenchmarkScene& s = BenchmarkScene::get(finish);
  RayLog log;
  benchmark::DoNotOptimize(traceImage(s, &log));
  double whole = 0, alone = 0;
  for (auto _ : state) {
    const double start = cpuSeconds();
    benchmark::DoNotOptimize(traceImage(s, nullptr));
    const double middle = cpuSeconds();
    for (const auto& [ray, isShadow] : log.rays) {
      Hit hit;
      if (isShadow)
        benchmark::DoNotOptimize(s.world.accel.transmittance(ray));
      else
        benchmark::DoNotOptimize(s.world.accel.intersect(ray, 0, hit));
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

BENCHMARK_CAPTURE(render, lambertian, demo::Finish::Lambertian)->Apply(inMilliseconds);
BENCHMARK_CAPTURE(render, conductors, demo::Finish::Conductors)->Apply(inMilliseconds);
BENCHMARK_CAPTURE(overhead, lambertian, demo::Finish::Lambertian)->Apply(inMilliseconds);
BENCHMARK_CAPTURE(overhead, conductors, demo::Finish::Conductors)->Apply(inMilliseconds);
BENCHMARK_CAPTURE(overhead, fine, demo::Finish::Fine)->Apply(inMilliseconds);

}  // namespace
}  // namespace chromeball

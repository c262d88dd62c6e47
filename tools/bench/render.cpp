// SPDX-License-Identifier: Apache-2.0
// The overhead of a render over ray tracing: samples and rays per second, and the time of the same
// rays replayed by Embree alone. CHROMEBALL_PROBE replaces the default probe, a studio.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>

#include "integrate/path_batch.h"
#include "integrate/render.h"
#include "scene.h"

BENCHMARK_MAIN();

namespace chromeball {
namespace {

constexpr int kTraced = PathBatch::kMaxPaths;  // samples per pixel

// Traces the paths of the whole image on this thread, as a render does; `log` may be null.
Rgb traceImage(const BenchmarkScene& s, RayLog* log) {
  const PathTracer tracer = s.tracer();
  const auto batch = std::make_unique<PathBatch>();
  std::array<std::optional<Hit>, kTraced> hits;
  const std::array<uint32_t, kTraced> keys{};
  return sumOverPixels(
      s.scene.cameras.front(), kTraced,
      [&](std::span<const Ray> rays, PathContext& context) {
        s.world.accel.intersect(rays, keys, Accel::Coherence::High, hits);
        batch->clear();
        for (size_t i = 0; i < rays.size(); ++i) {
          if (log) log->rays.push_back({rays[i], false});
          batch->add(PathState{rays[i]}, hits[i]);
        }
        batch->trace(tracer, 0, context);
        Rgb sum(0);
        for (size_t i = 0; i < rays.size(); ++i) sum += batch->radiance(i);
        return sum;
      },
      log);
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

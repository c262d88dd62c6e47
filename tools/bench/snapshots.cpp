// SPDX-License-Identifier: Apache-2.0
// The cost of snapshots: samples per second of a session whose snapshot is taken every 50 ms, over
// the samples per second of an undisturbed one. Both render in turn, for a second each time.
#include <benchmark/benchmark.h>

#include <chrono>
#include <thread>

#include "scene.h"
#include "session/session.h"

namespace chromeball {
namespace {

using namespace std::chrono_literals;

// The part of the samples that is taken in a second of processor time, after the first ones.
double rate(Session& session, const RenderDescription& description, bool watches) {
  session.start();
  while (!session.snapshot()) std::this_thread::sleep_for(10ms);
  const double before = session.fraction(), start = cpuSeconds(CLOCK_PROCESS_CPUTIME_ID);
  const auto end = std::chrono::steady_clock::now() + 1000ms;
  while (std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(50ms);
    if (watches) benchmark::DoNotOptimize(session.snapshot());
  }
  const double rate =
      (session.fraction() - before) / (cpuSeconds(CLOCK_PROCESS_CPUTIME_ID) - start);
  session.update(description);
  return rate;
}

void snapshots(benchmark::State& state) {
  const BenchmarkScene& s = BenchmarkScene::get(demo::Finish::Conductors);
  RenderDescription d;
  d.scene = std::make_shared<const Scene>(s.scene);
  d.probe.map = std::make_shared<const Image>(s.probe.latLong());
  d.lighting.strategy = "importance";
  d.size = ImageSize{int(state.range(0)), int(state.range(1))};
  d.settings.samples = kMaxSamples;
  Session watched(d), alone(d);
  double with = 0, without = 0;
  for (auto _ : state) {
    with += rate(watched, d, true);
    without += rate(alone, d, false);
  }
  state.counters["throughput"] = with / without;
}

BENCHMARK(snapshots)
    ->Args({640, 360})
    ->Args({1920, 1080})
    ->Unit(benchmark::kSecond)
    ->Iterations(4)
    ->UseRealTime();

}  // namespace
}  // namespace chromeball

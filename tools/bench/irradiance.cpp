// SPDX-License-Identifier: Apache-2.0
// The speed of the exact irradiance, a sum over texels and normals.
#include <benchmark/benchmark.h>

#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/synth.h"

namespace chromeball {
namespace {

// A pair of a texel and a normal is a dot product (5 operations), its positive part (1), and three
// products added (6).
constexpr double kFlopsPerPair = 12;

void countPairs(benchmark::State& state, double texels, double normals) {
  const double pairs = double(state.iterations()) * texels * normals;
  state.counters["pairs/s"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
  state.counters["FLOP/s"] = benchmark::Counter(pairs * kFlopsPerPair, benchmark::Counter::kIsRate);
}

void BM_ExactIrradianceOfNormals(benchmark::State& state) {
  const Image probe = constantProbe({1024, 512}, Rgb(1));
  const std::vector<vec3> normals = icosphereNormals(int(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(exactIrradiance(probe, normals));
  countPairs(state, 1024. * 512, double(normals.size()));
}
BENCHMARK(BM_ExactIrradianceOfNormals)
    ->Arg(3)
    ->Arg(5)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void BM_ExactIrradianceMap(benchmark::State& state) {
  const int height = int(state.range(0));
  const Image probe = constantProbe({2 * height, height}, Rgb(1));
  for (auto _ : state) benchmark::DoNotOptimize(irradianceMap(probe, {2 * height, height}));
  countPairs(state, 2. * height * height, 2. * height * height);
}
BENCHMARK(BM_ExactIrradianceMap)->Arg(128)->Arg(512)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_ShIrradianceMap(benchmark::State& state) {
  const Image probe = constantProbe({1024, 512}, Rgb(1));
  for (auto _ : state) benchmark::DoNotOptimize(shIrradianceMap(probe, {1024, 512}));
}
BENCHMARK(BM_ShIrradianceMap)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chromeball

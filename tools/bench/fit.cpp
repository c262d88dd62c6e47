// SPDX-License-Identifier: Apache-2.0
// The time of fitting directional lights, and the remaining error for each count. The probe is the
// file in CHROMEBALL_PROBE, or a studio.
#include <benchmark/benchmark.h>

#include "lighting/fit/irradiance_fit.h"
#include "lighting/fit/light_descent.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "scene.h"

namespace chromeball {
namespace {

const Image& fitProbe() {
  static const Image probe = benchmarkProbe({512, 256});
  return probe;
}

// The whole fit, including the exact irradiance of 20480 normals.
void irradianceFit(benchmark::State& state) {
  const Image& probe = fitProbe();
  IrradianceFit fit;
  for (auto _ : state) fit = fitIrradiance(probe, {.count = int(state.range(0))});
  state.counters["mean%"] = fit.meanError;
  state.counters["max%"] = fit.maxError;
}
BENCHMARK(irradianceFit)
    ->RangeMultiplier(2)
    ->Range(2, 256)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// The exact irradiance alone.
void irradianceOfTheProbe(benchmark::State& state) {
  const Image& probe = fitProbe();
  const std::vector<vec3> normals = icosphereNormals(5);
  for (auto _ : state) benchmark::DoNotOptimize(exactIrradiance(probe, normals));
}
BENCHMARK(irradianceOfTheProbe)->UseRealTime()->Unit(benchmark::kMillisecond);

// The inner loop: one light against a probe of the given number of rows.
void productWithALight(benchmark::State& state) {
  const RadiancePoints points(fitProbe(), int(state.range(0)), 1);
  for (auto _ : state) benchmark::DoNotOptimize(points.productWith(dvec3(0.6, 0.8, 0)));
}
BENCHMARK(productWithALight)->Arg(32)->Arg(64)->Arg(128)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace chromeball

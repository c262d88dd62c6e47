// SPDX-License-Identifier: Apache-2.0
// The cost of constellations of 300 lights: the tables of a 1024 x 512 map, and the lights from
// them. CHROMEBALL_PROBE may name another map.
#include <benchmark/benchmark.h>

#include "lighting/constellation/cube_grid.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/penrose.h"
#include "lighting/constellation/spherical_kmeans.h"
#include "scene.h"

namespace chromeball {
namespace {

constexpr int kLights = 300;

const Image& map() {
  static const Image image = benchmarkProbe();
  return image;
}

template <class Table, class... Arguments>
void build(benchmark::State& state, Arguments... arguments) {
  for (auto _ : state) {
    const Table table(map(), arguments...);
    benchmark::DoNotOptimize(&table);
  }
}

void regionTable(benchmark::State& state) { build<RegionTable>(state); }
void importanceTable(benchmark::State& state) { build<ImportanceTable>(state); }
void coarseTable(benchmark::State& state) { build<TexelTable>(state, kCoarseCells); }

template <class Table, class Make>
void placeLights(benchmark::State& state, const Table& table, Make make) {
  size_t lights = 0;
  for (auto _ : state) lights = make(table).size();
  state.counters["lights"] = double(lights);
}

void medianCut300(benchmark::State& state) {
  placeLights(state, RegionTable(map()),
              [](const auto& table) { return table.lights(medianCutRegions(table, kLights)); });
}
void varianceCut300(benchmark::State& state) {
  placeLights(state, RegionTable(map()),
              [](const auto& table) { return table.lights(varianceCutRegions(table, kLights)); });
}
void penrose300(benchmark::State& state) {
  placeLights(state, ImportanceTable(map()),
              [](const auto& table) { return penrose(table, kLights, 1); });
}
void lightGen300(benchmark::State& state) {
  placeLights(state, TexelTable(map(), kCoarseCells),
              [](const auto& table) { return lightGenClusters(table, kLights, 1).lights(); });
}
void kolligKeller300(benchmark::State& state) {
  placeLights(state, TexelTable(map(), kCoarseCells),
              [](const auto& table) { return kolligKellerClusters(table, kLights).lights(); });
}
void cubeGrid294(benchmark::State& state) {
  placeLights(state, TexelTable(map(), kFineCells),
              [](const auto& table) { return cubeGrid(table, 7); });
}

BENCHMARK(regionTable)->Unit(benchmark::kMillisecond);
BENCHMARK(importanceTable)->Unit(benchmark::kMillisecond);
BENCHMARK(coarseTable)->Unit(benchmark::kMillisecond);
BENCHMARK(medianCut300)->Unit(benchmark::kMillisecond);
BENCHMARK(varianceCut300)->Unit(benchmark::kMillisecond);
BENCHMARK(penrose300)->Unit(benchmark::kMillisecond);
BENCHMARK(lightGen300)->Unit(benchmark::kMillisecond);
BENCHMARK(kolligKeller300)->Unit(benchmark::kMillisecond);
BENCHMARK(cubeGrid294)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/lightgen.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "base/hash.h"
#include "lighting/constellation/spherical_kmeans.h"

namespace chromeball {
namespace {

constexpr int kStarts = 4;

// `count` different lit cells, drawn without replacement with probability proportional to weight:
// those with the smallest -log(u) / weight (Efraimidis and Spirakis 2006).
std::vector<int> drawCells(const SphericalKMeans& kMeans, int count, uint64_t key) {
  std::vector<double> order(kMeans.litCells());
  for (int i = 0; i < kMeans.litCells(); ++i)
    order[i] = -std::log(toUnit(uint32_t(hash(key, i))) + 0x1p-25) / kMeans.weight(i);
  std::vector<int> cells(order.size());
  std::iota(cells.begin(), cells.end(), 0);
  std::partial_sort(cells.begin(), cells.begin() + count, cells.end(), [&](int a, int b) {
    return order[a] != order[b] ? order[a] < order[b] : a < b;
  });
  cells.resize(count);
  return cells;
}

// The clusters with the smallest objective.
SphericalKMeans cluster(const TexelTable& table, int count, uint64_t seed) {
  const SphericalKMeans empty(table);
  std::optional<SphericalKMeans> best;
  double minimum = std::numeric_limits<double>::infinity();
  for (int start = 0; start < kStarts; ++start) {
    SphericalKMeans kMeans = empty;
    for (int cell : drawCells(kMeans, std::min(count, kMeans.litCells()), hash(seed, start)))
      kMeans.addCentre(cell);
    kMeans.converge(0);
    if (kMeans.objective() >= minimum) continue;
    minimum = kMeans.objective();
    best.emplace(std::move(kMeans));
  }
  return *best;
}

}  // namespace

Constellation lightGen(const TexelTable& table, int count, uint64_t seed) {
  return cluster(table, count, seed).lights();
}

Constellation lightGen(const Image& latLong, int count, uint64_t seed) {
  return lightGen(TexelTable(latLong, kCoarseCells), count, seed);
}

Partition lightGenRegions(const Image& latLong, int count, uint64_t seed) {
  const TexelTable table(latLong, kCoarseCells);
  return cluster(table, count, seed).partition(latLong);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/spherical_kmeans.h"

#include <limits>
#include <numeric>
#include <optional>

#include "base/hash.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

// Relative decrease of the objective at which iteration stops while lights are being added; each
// added light decreases it far more.
constexpr double kTolerance = 1e-3;

// A direction in the texel, uniform over its solid angle.
dvec3 pointInTexel(const Image& latLong, int x, int y, const dvec2& random) {
  const double top = std::cos(kPiD * y / latLong.height);
  const double bottom = std::cos(kPiD * (y + 1) / latLong.height);
  const double cosTheta = top + random.y * (bottom - top);
  return *uvToDirection(Mapping::LatLong,
                        {(x + random.x) / latLong.width, std::acos(cosTheta) / kPiD});
}

constexpr int kStarts = 4;

// `count` different lit cells, drawn without replacement with probability proportional to weight:
// the cells with the smallest -log(u) / weight (Efraimidis and Spirakis 2006).
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

}  // namespace

SphericalKMeans kolligKellerClusters(const TexelTable& table, int count) {
  SphericalKMeans kMeans(table);
  count = std::min(count, kMeans.litCells());
  for (int i = 0; i < count; ++i) {
    kMeans.addCentreAtWorst();
    kMeans.converge(kTolerance);
  }
  kMeans.converge(0);
  return kMeans;
}

Partition kolligKellerRegions(const Image& latLong, int count) {
  const TexelTable table(latLong, kCoarseCells);
  return kolligKellerClusters(table, count).partition(latLong);
}

Constellation kolligKellerStrata(const Image& latLong, int count, uint64_t seed) {
  const Partition partition = kolligKellerRegions(latLong, count);
  std::vector<dvec3> power(partition.regions, dvec3(0));
  std::vector<double> weight(partition.regions), running(partition.regions);
  if (partition.regions == 0) return {};
  const auto regionAt = [&](int x, int y) {
    return partition.label[size_t(y) * latLong.width + x];
  };
  forTexels(latLong, [&](int x, int y, const Rgb& radiance, double solidAngle) {
    const int region = regionAt(x, y);
    const dvec3 texelPower = dvec3(radiance) * solidAngle;
    power[region] += texelPower;
    weight[region] += luminance(texelPower);
  });

  // The light is in the texel at which the running sum of a region exceeds a random fraction of the
  // region's weight.
  Constellation lights(partition.regions);
  forTexels(latLong, [&](int x, int y, const Rgb& radiance, double solidAngle) {
    const int region = regionAt(x, y);
    const dvec3 texelPower = dvec3(radiance) * solidAngle;
    const auto random = [&](int i) { return toUnit(uint32_t(hash(seed, region, i))); };
    const double target = random(0) * weight[region], before = running[region];
    running[region] += luminance(texelPower);
    if (before <= target && running[region] > target)
      lights[region] =
          makeLight(pointInTexel(latLong, x, y, {random(1), random(2)}), power[region]);
  });
  return lights;
}

SphericalKMeans lightGenClusters(const TexelTable& table, int count, uint64_t seed) {
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

}  // namespace chromeball

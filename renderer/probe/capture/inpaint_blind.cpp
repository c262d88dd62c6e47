// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"
#include "probe/capture/assemble.h"

namespace chromeball {
namespace {

// A map with some known texels; the others are to be found.
struct PartialMap {
  int width, height;
  std::vector<dvec3> radiance;
  std::vector<bool> known;

  PartialMap(int w, int h)
      : width(w), height(h), radiance(size_t(w) * h, dvec3(0)), known(radiance.size(), false) {}

  size_t at(int x, int y) const { return size_t(y) * width + size_t((x + width) % width); }
  double sine(double row) const { return std::sin(kPiD * row / height); }  // at row 0.5: its centre
};

// The map at half its width and height: a texel is known if a part of it is, and is then the mean
// of that part, weighted by solid angle.
PartialMap coarser(const PartialMap& fine) {
  PartialMap coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  std::vector<double> weights(coarse.radiance.size());
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      if (fine.known[fine.at(x, y)]) {
        const size_t i = coarse.at(x / 2, y / 2);
        coarse.known[i] = true;
        coarse.radiance[i] += fine.sine(y + 0.5) * fine.radiance[fine.at(x, y)];
        weights[i] += fine.sine(y + 0.5);
      }
  for (size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) coarse.radiance[i] /= weights[i];
  return coarse;
}

// Bilinear interpolation of the coarser map at the unknown texels.
void start(PartialMap& fine, const PartialMap& coarse) {
  for (int y = 0; y < fine.height; ++y) {
    const double row = (y + 0.5) / fine.height * coarse.height - 0.5;
    const int top = int(std::floor(row));
    const double down = row - top;
    for (int x = 0; x < fine.width; ++x) {
      if (fine.known[fine.at(x, y)]) continue;
      const double column = (x + 0.5) / fine.width * coarse.width - 0.5;
      const int left = int(std::floor(column));
      const double across = column - left;
      const auto mean = [&](int r) {
        const int inside = std::clamp(r, 0, coarse.height - 1);
        return (1 - across) * coarse.radiance[coarse.at(left, inside)] +
               across * coarse.radiance[coarse.at(left + 1, inside)];
      };
      fine.radiance[fine.at(x, y)] = (1 - down) * mean(top) + down * mean(top + 1);
    }
  }
}

// Replaces an unknown texel by the mean of its neighbours for which the Laplacian on the sphere, by
// finite volumes, is 0. Nothing flows through the poles.
void relax(PartialMap& map, int x, int y) {
  const double side = 2 * kPiD / map.width, height = kPiD / map.height;
  const double across = height / (side * map.sine(y + 0.5));
  const double up = y > 0 ? map.sine(y) * side / height : 0;
  const double down = y + 1 < map.height ? map.sine(y + 1) * side / height : 0;
  dvec3 sum = across * (map.radiance[map.at(x - 1, y)] + map.radiance[map.at(x + 1, y)]);
  if (up > 0) sum += up * map.radiance[map.at(x, y - 1)];
  if (down > 0) sum += down * map.radiance[map.at(x, y + 1)];
  map.radiance[map.at(x, y)] = sum / (2 * across + up + down);
}

void relax(PartialMap& map) {
  constexpr int kSweeps = 16;  // in both orders
  struct Place {
    int x, y;
  };
  std::vector<Place> unknown;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if (!map.known[map.at(x, y)]) unknown.push_back({x, y});
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (auto p = unknown.begin(); p != unknown.end(); ++p) relax(map, p->x, p->y);
    for (auto p = unknown.rbegin(); p != unknown.rend(); ++p) relax(map, p->x, p->y);
  }
}

void solve(PartialMap& map) {
  if (std::find(map.known.begin(), map.known.end(), false) == map.known.end()) return;
  PartialMap coarse = coarser(map);
  solve(coarse);
  start(map, coarse);
  relax(map);
}

}  // namespace

void inpaintBlind(Assembly& assembly) {
  PartialMap map(assembly.latLong.width, assembly.latLong.height);
  bool isBlind = true;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const bool isKnown = *assembly.coverage.at(x, y) > 0;
      map.known[map.at(x, y)] = isKnown;
      map.radiance[map.at(x, y)] = dvec3(assembly.latLong.rgb(x, y));
      isBlind = isBlind && !isKnown;
    }
  if (isBlind) throwInput("probe assemble: the photographs and masks leave no direction to see");
  solve(map);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      assembly.latLong.setRgb(x, y, Rgb(map.radiance[map.at(x, y)]));
}

}  // namespace chromeball

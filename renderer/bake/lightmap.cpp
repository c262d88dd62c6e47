// SPDX-License-Identifier: Apache-2.0
#include "bake/lightmap.h"

#include <unordered_map>

#include "bake/texel_filter.h"
#include "base/parallel.h"

namespace chromeball {

Lightmap makeLightmap(const PointLight& what, const std::vector<BakePoint>& points,
                      const BakeResult& baked, const std::vector<Rgb>& light, const Atlas& atlas) {
  const int size = atlas.size;
  Lightmap map{Image(size, size, 3), Image(size, size, 4)};
  std::vector<uint8_t> isBaked(size_t(size) * size_t(size));
  forRanges(points.size(), 100, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (baked.points[i].buried) continue;
      const int x = int(points[i].x), y = int(points[i].y);
      isBaked[size_t(y) * size_t(size) + size_t(x)] = 1;
      map.light.setRgb(x, y, light[i]);
      const vec4 shown = shownColor(what, points[i], light[i]);
      for (int c = 0; c < 4; ++c) map.shown.at(x, y)[c] = shown[c];
    }
  });
  for (const BakePoint& point : points)
    if (countsForScale(what.scene(), point.instance))
      map.brightest =
          std::max(map.brightest, maxComponent(map.shown.rgb(int(point.x), int(point.y))));
  fillPage(map.light, isBaked, atlas);
  fillPage(map.shown, std::move(isBaked), atlas);
  return map;
}

std::vector<BakedGeometry> lightmappedGeometry(const std::vector<PlacedMesh>& meshes,
                                               const std::vector<Chart>& charts,
                                               const Atlas& atlas) {
  std::vector<BakedGeometry> all;
  for (const PlacedMesh& placed : meshes) all.emplace_back(placed);
  for (size_t i = 0; i < charts.size(); ++i) {
    const Chart& chart = charts[i];
    const PlacedMesh& placed = meshes[size_t(chart.instance)];
    BakedGeometry& geometry = all[size_t(chart.instance)];
    std::unordered_map<uint32_t, uint32_t> ofChart;
    for (const uint32_t triangle : chart.triangles) {
      Triangle own;
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = placed.triangle(triangle)[corner];
        const auto [found, isNew] = ofChart.try_emplace(vertex, uint32_t(geometry.vertices.size()));
        own[corner] = found->second;
        if (!isNew) continue;
        geometry.vertices.push_back(vertex);
        geometry.lightmapUv.emplace_back(atlas.toPage(i, chart.project(placed.positions[vertex])) /
                                         double(atlas.size));
      }
      geometry.add(own);
    }
  }
  return all;
}

}  // namespace chromeball

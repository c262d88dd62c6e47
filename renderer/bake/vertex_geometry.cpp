// SPDX-License-Identifier: Apache-2.0
#include "bake/vertex_geometry.h"

namespace chromeball {

std::vector<BakedGeometry> vertexGeometry(const std::vector<PlacedMesh>& meshes,
                                          const std::vector<BakePoint>& points) {
  std::vector<BakedGeometry> all;
  size_t at = 0;
  for (const PlacedMesh& placed : meshes) {
    BakedGeometry& geometry = all.emplace_back(placed);
    std::vector<uint32_t> own(placed.positions.size());
    for (; at < points.size() && points[at].instance == placed.instance; ++at) {
      own[points[at].x] = uint32_t(geometry.vertices.size());
      geometry.vertices.push_back(points[at].x);
    }
    for (uint32_t i = 0; i < placed.triangleCount(); ++i)
      if (const Triangle& t = placed.triangle(i); placed.hasArea(i))
        geometry.add({own[t.x], own[t.y], own[t.z]});
  }
  return all;
}

void fillVertices(const std::vector<Triangle>& triangles, std::vector<Rgb>& light,
                  std::vector<uint8_t> isLit) {
  for (bool grows = true; grows;) {
    grows = false;
    std::vector<Rgb> sums(light.size(), Rgb(0));
    std::vector<int> counts(light.size());
    for (const Triangle& t : triangles)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          if (!isLit[t[a]] && isLit[t[b]]) {
            sums[t[a]] += light[t[b]];
            ++counts[t[a]];
          }
    for (size_t i = 0; i < light.size(); ++i) {
      if (counts[i] == 0) continue;
      light[i] = sums[i] / float(counts[i]);
      isLit[i] = 1;
      grows = true;
    }
  }
}

}  // namespace chromeball

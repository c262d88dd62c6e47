// SPDX-License-Identifier: Apache-2.0
#include "bake_scenes.h"

namespace chromeball {

std::vector<Chart> chartsOf(const std::vector<PlacedMesh>& meshes) {
  std::vector<Chart> charts;
  for (const PlacedMesh& placed : meshes)
    for (Chart& chart : makeCharts(placed)) charts.push_back(std::move(chart));
  return charts;
}

void addBox(Scene& scene, int material, vec3 low, vec3 high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  addMesh(scene, material, std::move(mesh));
}

Mesh spiral() {
  Mesh mesh;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const float phi = 4 * kPi * float(i) / kSteps, height = 0.01f * float(i);
    for (const float radius : {2.0f, 1.0f})
      mesh.positions.push_back({radius * std::cos(phi), height, -radius * std::sin(phi)});
  }
  for (uint32_t i = 0; i < 2 * kSteps; i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 1});
    mesh.triangles.push_back({i + 1, i + 2, i + 3});
  }
  return mesh;
}

Scene varied() {
  Scene scene = threeScenes()[0].scene;
  addBox(scene, 0, {1, 0, 1}, {2, 1, 2});
  addMesh(scene, 0, spiral());
  Instance mirrored{int(scene.meshes.size()) - 1, 0, 0, {}};
  mirrored.toWorld = Transform{glm::mat3(-1, 0, 0, 0, 2, 0, 0, 0, 1), vec3(9, 0, 0)};
  scene.instances.push_back(mirrored);
  return scene;
}

}  // namespace chromeball

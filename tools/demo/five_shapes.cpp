// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"
#include "glb_objects.h"
#include "stone.h"
#include "turned.h"

namespace chromeball::demo {
namespace {

const Profile kSlab = filleted({{0, -0.3}, {2.55, -0.3}, {2.6, 0}, {0, 0}}, 0.025);

std::vector<Object> shapes() {
  const dvec3 cylinder(0.8, 0, 0.85), cone(-0.95, 0, -0.72);
  return {
      {.name = "steel ball",
       .surface = tessellate(128, 64, ball({0.12, 0.55, -0.35}, 0.55), Uvs::Parameters),
       .color = {0.78f, 0.78f, 0.8f},
       .metallic = 1,
       .roughness = 0.03f},
      {.name = "blue cone",
       .surface = tessellateTurned(128, cone, filleted({{0, 0}, {0.46, 0}, {0, 1.25}}, 0.02)),
       .color = {0.02f, 0.075f, 0.3f},
       .roughness = 0.15f},
      {.name = "clay cube",
       .surface = tessellate(128, 64, softCube({1.25, 0.4, -0.25}, 0.4, 0.62), Uvs::Parameters),
       .color = {0.36f, 0.16f, 0.09f},
       .lambertian = true},
      {.name = "gold ring",
       .surface = tessellate(160, 48, torus({-0.62, 0.16, 0.55}, 0.4, 0.16), Uvs::Parameters),
       .color = {1, 0.71f, 0.29f},
       .metallic = 1,
       .roughness = 0.22f},
      {.name = "glass cylinder",
       .surface = tessellateTurned(128, cylinder + dvec3(0, 1e-3, 0),
                                   filleted({{0, 0}, {0.24, 0}, {0.24, 0.62}, {0, 0.62}}, 0.03)),
       .color = {1, 1, 1},
       .glass = true},
  };
}

}  // namespace

void writeFiveShapes(const std::string& path) {
  GltfDocument glb;
  const SolidTexture stone = marble({0.5f, 0.47f, 0.43f}, {0.2f, 0.17f, 0.15f}, 2.6f);
  const Parametrisation slab = turned({0, 0, 0}, kSlab);
  const Parametrisation top = patch({-2.6, 0, -2.6}, {5.2, 0, 0}, {0, 0, 5.2});
  Object ground{.name = "slab",
                .surface = tessellate(192, int(kSlab.size()) - 1, slab),
                .color = {1, 1, 1},
                .roughness = 0.45f};
  for (vec2& uv : ground.surface.uvs) uv = (uv - 0.5f) * float(2 * kTableRadius / 5.2) + 0.5f;
  ground.texture = addTexture(glb, carve({1024, 1024}, top, stone));
  addObject(glb, ground);
  for (const Object& shape : shapes()) addObject(glb, shape);
  writeScene(glb, "View",
             Camera::lookAt({0.35f, 1.15f, 5.4f}, {0.1f, 0.5f, 0}, {0, 1, 0}, glm::radians(24.0f)),
             path);
}

}  // namespace chromeball::demo

// SPDX-License-Identifier: Apache-2.0
// The models of the comparison with other renderers have the materials that their names promise.
#include <gtest/gtest.h>

#include <algorithm>

#include "demo/gallery.h"
#include "math/icosphere.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"
#include "trace/accel.h"

namespace chromeball::demo_scene_test {
namespace {

Scene sceneOf(demo::Finish finish) {
  const TemporaryFolder folder;
  demo::writeStillLife(folder / "model.glb", finish);
  return loadGltf(folder / "model.glb", {}, nullptr);
}

std::vector<Material> materialsOf(demo::Finish finish) { return sceneOf(finish).materials; }

TEST(DemoScene, LambertianHasOnlyDiffuseMaterials) {
  for (const Material& m : materialsOf(demo::Finish::Lambertian)) {
    EXPECT_EQ(m.metallic, 0) << m.name;
    EXPECT_EQ(m.specular, 0) << m.name;
    EXPECT_FALSE(m.extended) << m.name;
  }
}

TEST(DemoScene, ConductorsHaveThreeMetalsOfTheirOwnRoughness) {
  std::vector<float> roughnesses;
  for (const Material& m : materialsOf(demo::Finish::Conductors))
    if (m.metallic == 1) roughnesses.push_back(m.roughness);
  ASSERT_EQ(roughnesses.size(), 3u);
  EXPECT_FLOAT_EQ(std::ranges::min(roughnesses), 0.2f);
  EXPECT_LT(std::ranges::max(roughnesses), 1);
}

TEST(DemoScene, GlassHasTwoSmoothBodies) {
  const std::vector<Material> materials = materialsOf(demo::Finish::Glass);
  EXPECT_EQ(std::ranges::count_if(materials,
                                  [](const Material& m) { return m.isBody() && m.roughness == 0; }),
            2);
}

TEST(DemoScene, PlasticsAreGlossyDielectrics) {
  for (const Material& m : materialsOf(demo::Finish::Plastics)) {
    EXPECT_EQ(m.metallic, 0) << m.name;
    EXPECT_EQ(m.specular, 1) << m.name;
    EXPECT_FLOAT_EQ(m.roughness, 0.3f) << m.name;
  }
}

TEST(DemoScene, TheRoomIsClosedButForItsWindow) {
  const Scene scene = sceneOf(demo::Finish::Room);
  const Accel accel(scene);
  const vec3 above(0, 2, 0);
  int escaped = 0;
  for (const vec3& direction : icosphereNormals(5)) {
    Hit hit;
    if (accel.intersect({above, direction}, 0, hit)) continue;
    ++escaped;
    const vec3 seen = above + direction * (3 / -direction.x);  // in the plane of the window
    EXPECT_TRUE(seen.y > 0.5f && seen.y < 2.8f && seen.z > -1 && seen.z < 2) << seen.y << seen.z;
  }
  EXPECT_GT(escaped, 100);
}

TEST(SlowDemoScene, FineHasManyTriangles) {
  size_t triangles = 0;
  for (const Mesh& mesh : sceneOf(demo::Finish::Fine).meshes) triangles += mesh.triangles.size();
  EXPECT_GT(triangles, 800'000u);
}

}  // namespace
}  // namespace chromeball::demo_scene_test

// SPDX-License-Identifier: Apache-2.0
// The models of the comparison with other renderers have the materials that their names promise.
#include <gtest/gtest.h>

#include <algorithm>

#include "demo/still_life.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {
namespace {

std::vector<Material> materialsOf(demo::Finish finish) {
  const TemporaryFolder folder;
  demo::writeStillLife(folder / "model.glb", finish);
  return loadGltf(folder / "model.glb", {}, nullptr).materials;
}

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

}  // namespace
}  // namespace chromeball

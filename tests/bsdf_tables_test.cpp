// SPDX-License-Identifier: Apache-2.0
// The tables that a scene's materials need, and the consistency of their values.
#include <gtest/gtest.h>

#include "all_tables.h"

namespace chromeball::bsdf_tables_test {
namespace {

Material lambertian() {
  Material m;
  m.metallic = 0;
  m.specular = 0;
  return m;
}

struct Needs {
  bool energy, anisotropic, sheen, glass;
  bool operator==(const Needs&) const = default;
};

Needs builtFor(const std::vector<Material>& materials) {
  const BsdfTables tables(materials);
  return {tables.energy != nullptr, tables.anisotropic != nullptr, tables.sheen != nullptr,
          tables.glass != nullptr};
}

TEST(BsdfTables, lambertianMaterialsNeedNone) {
  EXPECT_EQ(builtFor({}), (Needs{false, false, false, false}));
  EXPECT_EQ(builtFor({lambertian(), lambertian()}), (Needs{false, false, false, false}));
}

TEST(SlowBsdfTables, otherMaterialsNeedOnlyTheirOwn) {
  Material metal = lambertian(), plastic = lambertian(), coated = lambertian();
  metal.metallic = 0.1f;
  plastic.specular = 0.1f;
  coated.extended.emplace().clearcoat = 1;
  for (const Material& m : {metal, plastic, coated})
    EXPECT_EQ(builtFor({lambertian(), m}), (Needs{true, false, false, false}));

  Material cloth = lambertian(), brushed = lambertian(), glass = lambertian();
  cloth.extended.emplace().sheenColor = Rgb(0, 0, 0.1f);
  EXPECT_EQ(builtFor({cloth}), (Needs{true, false, true, false}));
  brushed.extended.emplace().anisotropy = 0.1f;
  EXPECT_EQ(builtFor({brushed}), (Needs{true, true, false, false}));
  glass.extended.emplace().transmission = 0.1f;
  EXPECT_EQ(builtFor({glass}), (Needs{true, false, false, false}));
  glass.extended->thinWalled = false;
  EXPECT_EQ(builtFor({glass}), (Needs{true, false, false, true}));
  glass.roughness = 0;
  EXPECT_EQ(builtFor({glass}), (Needs{true, false, false, false}));
}

// Both tables hold the same function for strength 0.
TEST(BsdfTables, anisotropyOfStrengthZeroIsIsotropic) {
  const BsdfTables& tables = allTables();
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
    for (const float mu : {0.2f, 0.5f, 1.0f}) {
      const SpecularAlbedo isotropic = tables.energy->row(roughness).at(mu);
      const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
      const SpecularAlbedo anisotropic = tables.anisotropic->albedo(wo, roughness, 0);
      EXPECT_NEAR(isotropic.a, anisotropic.a, 0.01f) << roughness << " " << mu;
      EXPECT_NEAR(isotropic.b, anisotropic.b, 0.01f) << roughness << " " << mu;
    }
}

}  // namespace
}  // namespace chromeball::bsdf_tables_test

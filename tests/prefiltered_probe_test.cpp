// SPDX-License-Identifier: Apache-2.0
// Prefiltered probes: tables against convolutions, and rotation.
#include <gtest/gtest.h>

#include <random>

#include "probe/convolve.h"
#include "probe/irradiance.h"
#include "probe/prefiltered_probe.h"
#include "probe/synth.h"
#include "test_probes.h"

namespace chromeball::prefiltered_probe_test {
namespace {

std::vector<vec3> randomDirections(int count) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<vec3> directions;
  for (int i = 0; i < count; ++i)
    directions.push_back(glm::normalize(vec3(normal(random), normal(random), normal(random))));
  return directions;
}

TEST(SlowPrefilteredProbe, AConstantStaysConstant) {
  Image map(64, 32, 3);
  for (float& texel : map.texels) texel = 0.7f;
  const Probe probe(map);
  const PrefilteredProbe filtered(probe, {0.2f, 0.6f});
  for (const vec3& d : randomDirections(50)) {
    EXPECT_NEAR(filtered.irradiance(d).y, 0.7 * kPiD, 3e-4);
    for (const float roughness : {0.0f, 0.1f, 0.2f, 0.4f, 0.6f, 0.9f, 1.0f})
      EXPECT_NEAR(filtered.radiance(d, roughness).y, 0.7f, 1e-4f) << roughness;
  }
}

TEST(SlowPrefilteredProbe, TablesAgreeWithConvolutions) {
  const Image map = studioProbe({128, 64});
  const Rotation rotation = Rotation::ofAngles({40, 20, -10});
  const Probe probe(map, rotation);
  const PrefilteredProbe filtered(probe, {0.3f, 0.5f});
  const std::vector<vec3> directions = randomDirections(300);
  std::vector<vec3> inMap;
  for (const vec3& d : directions) inMap.push_back(rotation.back(d));
  const std::vector<dvec3> irradiance = exactIrradiance(map, inMap);
  double meanIrradiance = 0;
  for (const dvec3& e : irradiance) meanIrradiance += e.y / double(irradiance.size());
  for (size_t i = 0; i < directions.size(); ++i)
    EXPECT_NEAR(filtered.irradiance(directions[i]).y, irradiance[i].y, 2e-3 * meanIrradiance);
  for (const float roughness : {0.3f, 0.5f}) {
    const std::vector<dvec3> exact = convolve(map, ZonalKernel::ggx(roughness), inMap);
    for (size_t i = 0; i < directions.size(); ++i)
      EXPECT_NEAR(filtered.radiance(directions[i], roughness).y, exact[i].y,
                  0.02 * exact[i].y + 0.01 * meanIrradiance / kPiD)
          << roughness;
  }
  for (const vec3& d : directions) {
    const Rgb seen = probe.radiance(d);
    EXPECT_LT(maxComponent(absolute(filtered.radiance(d, 0) - seen)), 1e-5f * maxComponent(seen));
  }
}

TEST(PrefilteredProbe, BearsRadianceFromTinyToHuge) {
  const Image map = spot(64, 32, 40, 6, 500, 0.2f);
  const Probe one(map);
  const PrefilteredProbe expected(one, {0.5f});
  for (const float scale : {1e-8f, 1e10f}) {
    const Probe probe(map, {}, Rgb(scale));
    const PrefilteredProbe filtered(probe, {0.5f});
    for (const vec3& d : randomDirections(50)) {
      EXPECT_NEAR(filtered.irradiance(d).y / scale / expected.irradiance(d).y, 1, 1e-4);
      EXPECT_NEAR(filtered.radiance(d, 0.5f).y / scale / expected.radiance(d, 0.5f).y, 1, 1e-4);
    }
  }
}

}  // namespace
}  // namespace chromeball::prefiltered_probe_test

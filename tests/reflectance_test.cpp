// SPDX-License-Identifier: Apache-2.0
// The reflectance of the local scene, estimated from a render with known reflectance.
#include "composite/reflectance.h"
#include "composite/local_scene.h"

#include <gtest/gtest.h>

#include "composite/compose.h"
#include "composite/render_composite.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::reflectance_test {
namespace {

constexpr int kSize = 24;
const std::atomic<bool> kStop = false;
const auto kQuiet = [](double) {};

Image skyProbe() {
  Image probe = gradientProbe({32, 16}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
  probe.setRgb(9, 3, Rgb(40, 30, 20));
  return probe;
}

// A local scene of a floor and, if given, a wall that forms a corner with it.
struct Local {
  Scene scene;
  Camera camera = Camera::lookAt({0.3f, 2, 2.2f}, {0, 0.3f, 0}, {0, 1, 0}, 0.6f);
  ObjectMask isObject;
  Probe probe{skyProbe(), 25};

  Local(const Rgb& floor, std::optional<Rgb> wall) {
    addQuad(scene, addMaterial(scene, lambert(floor)), {-30, 0, 30}, {60, 0, 0}, {0, 0, -60});
    if (wall)
      addQuad(scene, addMaterial(scene, lambert(*wall)), {-30, 0, -0.8f}, {60, 0, 0}, {0, 4, 0});
    isObject.resize(scene.instances.size(), false);
  }

  // A render without the probe in the background.
  Image photograph(int samples = 512, uint64_t seed = 1) const {
    RenderSettings settings = smallRender(kSize, kSize, samples, 8, seed);
    settings.hideProbe = true;
    return renderScene(scene, camera, probe, "importance", settings).film.mean();
  }

  // Estimates the reflectance from the plate; `projected` replaces the model's own reflectance.
  ReflectanceSolution solve(const Image& plate, int iterations, Projection& projection,
                            bool projected = true) {
    if (projected) makeProjected(scene, isObject, projection);
    const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
    const World world(scene, rayMasks(isObject), allTables());
    return solveReflectance({world, camera, *lighting, plate}, smallRender(kSize, kSize, 512, 8, 2),
                            iterations, projection, kQuiet, kStop);
  }
};

// Mean over pixels that see only the floor (the lower third of the image) or only the wall.
Rgb meanOf(const Image& image, bool floor) {
  glm::dvec3 sum(0);
  int count = 0;
  for (int y = floor ? 16 : 0; y < (floor ? kSize : 4); ++y)
    for (int x = 0; x < kSize; ++x) sum += glm::dvec3(image.rgb(x, y)), ++count;
  return Rgb(sum / double(count));
}

void expectNear(const Rgb& found, const Rgb& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

// Without interreflection in the local scene, one iteration is exact, both with rendered irradiance
// and with the exact irradiance for the ground's normal.
TEST(Reflectance, OfAFlatGroundRenderedAndExact) {
  const Rgb expected(0.6f, 0.3f, 0.1f);
  Local local(expected, std::nullopt);
  const Image plate = local.photograph();
  Projection rendered(local.camera, kSize, kSize), exact = rendered;
  const ReflectanceSolution solution = local.solve(plate, 1, rendered);
  EXPECT_EQ(solution.clamped, 0u);
  EXPECT_NEAR(solution.exposureRatio, 1, 0.01);
  expectNear(meanOf(rendered.colors(), true), expected, 0.006f);

  const auto normal = flatNormal(local.scene, local.isObject);
  ASSERT_TRUE(normal);
  EXPECT_EQ(*normal, vec3(0, 1, 0));
  const Rgb irradiance(exactIrradiance(local.probe.latLong(), {&*normal, 1})[0]);
  const auto lighting = makeStrategy("importance", local.probe, Mis::Balance, "test");
  const World world(local.scene, rayMasks(local.isObject));
  solveFlatReflectance({world, local.camera, *lighting, plate}, smallRender(kSize, kSize, 1, 8),
                       irradiance, exact, kStop);
  expectNear(meanOf(exact.colors(), true), expected, 0.006f);
  expectNear(meanOf(exact.colors(), true), meanOf(rendered.colors(), true), 0.006f);
}

// An unlit surface shows its base colour, and an emitting one reflects the rest of the plate.
TEST(Reflectance, OfUnlitAndEmittingGround) {
  const Rgb plate(0.3f, 0.2f, 0.15f), emission(0.1f, 0.05f, 0.02f);
  for (const bool unlit : {true, false}) {
    Local local(Rgb(0.5f), std::nullopt);
    Material& ground = local.scene.materials[0];
    ground.unlit = unlit;
    if (!unlit) ground.emission = emission;
    Image photograph(kSize, kSize, 3);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) photograph.setRgb(x, y, plate);
    const vec3 normal(0, 1, 0);
    const Rgb irradiance(exactIrradiance(local.probe.latLong(), {&normal, 1})[0]);
    const Rgb expected = unlit ? plate : (plate - emission) * kPi / irradiance;
    Projection rendered(local.camera, kSize, kSize), exact = rendered;
    local.solve(photograph, 1, rendered);
    expectNear(meanOf(rendered.colors(), true), expected, 0.006f);
    const auto lighting = makeStrategy("importance", local.probe, Mis::Balance, "test");
    const World world(local.scene, rayMasks(local.isObject));
    solveFlatReflectance({world, local.camera, *lighting, photograph},
                         smallRender(kSize, kSize, 1, 8), irradiance, exact, kStop);
    expectNear(meanOf(exact.colors(), true), expected, 1e-5f);
  }
}

TEST(Reflectance, FlatNormalExistsOnlyForOnePlane) {
  EXPECT_FALSE(flatNormal(Local(Rgb(0.5f), Rgb(0.5f)).scene, {false, false}));
  EXPECT_TRUE(flatNormal(Local(Rgb(0.5f), Rgb(0.5f)).scene, {false, true}));
  Scene steps;
  for (float height : {0.0f, 0.1f})
    addQuad(steps, addMaterial(steps, lambert(Rgb(1))), {-1, height, 1}, {2, 0, 0}, {0, 0, -2});
  EXPECT_FALSE(flatNormal(steps, {false, false}));
}

// With interreflection in a corner, the first iteration has an error and later ones converge.
TEST(SlowReflectance, OfACornerConverges) {
  const Rgb floor(0.8f, 0.7f, 0.6f), wall(0.9f, 0.5f, 0.3f);
  const Image plate = Local(floor, wall).photograph();
  double before = 1;
  for (int iterations : {1, 2, 4}) {
    Local local(floor, wall);
    Projection projection(local.camera, kSize, kSize);
    const ReflectanceSolution solution = local.solve(plate, iterations, projection);
    const double error = glm::length(meanOf(projection.colors(), true) - floor) +
                         glm::length(meanOf(projection.colors(), false) - wall);
    EXPECT_LT(error, before) << iterations;
    EXPECT_LT(solution.lastChange, iterations == 4 ? 0.02 : 1);
    before = error;
  }
  EXPECT_LT(before, 0.04);
}

// With the estimated and projected reflectance, a render of the local scene equals the plate, also
// if the plate has a pattern that the model lacks; the same for its reflection in a small mirror.
TEST(SlowReflectance, RenderWithEstimatedReflectanceEqualsThePlate) {
  Local local(Rgb(0.5f), std::nullopt);
  Image plate = local.photograph();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Rgb paint = x < kSize / 2 ? Rgb(0.2f, 1, 0.5f) : Rgb(1.6f, 0.4f, 1);
      plate.setRgb(x, y, plate.rgb(x, y) * paint);
    }
  Projection projection(local.camera, kSize, kSize);
  local.solve(plate, 1, projection);
  const Image again = local.photograph(512, 5);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(again.rgb(x, y)[c] / plate.rgb(x, y)[c], 1, 0.12) << x << " " << y;

  constexpr float kBottom = 0.05f, kTop = 0.35f, kHalfWidth = 0.25f;
  Material mirror;
  mirror.roughness = 0;
  addQuad(local.scene, addMaterial(local.scene, mirror), {-kHalfWidth, kBottom, 0.5f},
          {2 * kHalfWidth, 0, 0}, {0, kTop - kBottom, 0});
  const Image mirrored = local.photograph(512, 6);
  const CameraRays rays(local.camera, 1);
  Projection photograph = projection;
  photograph.colors() = plate;
  int compared = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      // Look up the points of the floor that the pixel's corners see in the mirror.
      std::optional<Rgb> colour;
      bool isWhole = true;
      for (int corner = 0; corner < 4; ++corner) {
        vec3 origin, direction;
        rays.ray(float(x + corner % 2) / kSize, float(y + corner / 2) / kSize, origin, direction);
        const vec3 onMirror = origin + (0.5f - origin.z) / direction.z * direction;
        isWhole &= std::abs(onMirror.x) < kHalfWidth && onMirror.y > kBottom && onMirror.y < kTop;
        const vec3 back(direction.x, direction.y, -direction.z);
        const auto found = photograph.lookup(onMirror - onMirror.y / back.y * back);
        isWhole &= found && (!colour || glm::length(*colour - *found) < 0.1f * glm::length(*found));
        colour = found;
      }
      if (!isWhole) continue;
      ++compared;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mirrored.rgb(x, y)[c] / (*colour)[c], 1, 0.2) << x << " " << y;
    }
  EXPECT_GE(compared, 6);
}

// If the plate is twice as bright as the probe implies, the reflectance would need an albedo above
// 1; the ratio of exposures is reported.
TEST(Reflectance, ReportsDifferentExposures) {
  Local local(Rgb(0.7f), std::nullopt);
  Image plate = local.photograph();
  for (float& texel : plate.texels) texel *= 2;
  Projection projection(local.camera, kSize, kSize);
  const ReflectanceSolution solution = local.solve(plate, 1, projection);
  EXPECT_GT(solution.clamped, solution.pixels / 2);
  EXPECT_NEAR(solution.exposureRatio, 2, 0.03);
  EXPECT_LE(maxComponent(meanOf(projection.colors(), true)), 1);
}

// What is clamped keeps its hue, so that the floor takes light of all channels alike.
TEST(Reflectance, IsClampedAsAWholeColour) {
  Local local(Rgb(0.7f, 0.6f, 0.35f), std::nullopt);
  Image plate = local.photograph();
  for (float& texel : plate.texels) texel *= 2;
  Projection projection(local.camera, kSize, kSize);
  local.solve(plate, 1, projection);
  expectNear(meanOf(projection.colors(), true), Rgb(1, 6 / 7.0f, 0.5f), 0.01f);
}

// The specular reflection of a glossy floor is subtracted from the plate before solving.
TEST(SlowReflectance, OfAGlossyFloorExcludesItsHighlights) {
  const Rgb expected(0.3f, 0.2f, 0.1f);
  Local local(expected, std::nullopt);
  makeGlossy(local.scene, local.isObject, 1, 0.3f);
  const Image plate = local.photograph(1024);
  Projection projection(local.camera, kSize, kSize);
  makeProjected(local.scene, local.isObject, projection);
  makeGlossy(local.scene, local.isObject, 1, 0.3f);
  local.solve(plate, 1, projection, false);
  expectNear(meanOf(projection.colors(), true), expected, 0.012f);
}

// The light that coats, sheen and transmission add to a plate, or keep from the base, is not
// attributed to the base colour. A local scene with all of them is lit as its plate shows it.
TEST(SlowReflectance, OfLayeredFloorsIsThatOfTheirBase) {
  const Rgb expected(0.3f, 0.2f, 0.1f);
  ExtendedMaterial coat, sheen, sheet;
  coat.clearcoat = 1, coat.clearcoatRoughness = 0.3f;
  sheen.sheenColor = {0.6f, 0.3f, 0.6f}, sheen.sheenRoughness = 0.4f;
  sheet.transmission = 0.5f;
  for (const ExtendedMaterial& layers : {coat, sheen, sheet}) {
    Local local(expected, std::nullopt);
    local.scene.materials[0].extended = layers;
    EXPECT_TRUE(isLayered(local.scene, local.isObject));
    const Image plate = local.photograph(1024);
    Projection projection(local.camera, kSize, kSize);
    local.solve(plate, 1, projection);
    expectNear(meanOf(projection.colors(), true), expected, 0.012f);
    const Rgb again = meanOf(local.photograph(1024, 9), true);
    expectNear(again / meanOf(plate, true), Rgb(1), 0.03f);
  }
}

}  // namespace
}  // namespace chromeball::reflectance_test

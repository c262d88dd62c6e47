// SPDX-License-Identifier: Apache-2.0
// Surroundings of shape `model`: the walls are the triangles of a room model.
#include "trace/room.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "floor_in_surroundings.h"
#include "probe/synth.h"

namespace chromeball::room_test {
namespace {

const vec3 kMin = box().min, kMax = box().max, kCapture = box().capture;

Surroundings room() {
  Surroundings s = box();
  s.shape = Surroundings::Shape::Model;
  return s;
}

enum class Furniture { None, Screen };

// The box as a mesh, with walls of both orientations. The screen hides a corner of the room from
// the capture point.
Scene boxModel(bool hasCeiling, Furniture furniture) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.5f)));
  const vec3 size = kMax - kMin, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  addQuad(scene, grey, kMin, z, x);
  addQuad(scene, grey, kMin, x, y);
  addQuad(scene, grey, kMin, y, z);
  addQuad(scene, grey, kMax, -x, -y);
  addQuad(scene, grey, kMax, -y, -z);
  if (hasCeiling) addQuad(scene, grey, kMax, -z, -x);
  if (furniture == Furniture::Screen) addQuad(scene, grey, {-1, 0, 0.6f}, {0, 2, 0}, {0, 0, 1.4f});
  return scene;
}

TEST(Room, AModelOfABoxEqualsTheAnalyticBox) {
  const Room walls(boxModel(true, Furniture::None), kCapture, "test");
  for (uint64_t i = 0; i < 1000; ++i) {
    const vec3 from = kCapture + 0.9f * toUnit(uint32_t(hash(i, 7))) * sphereDirection(i + 1000);
    const auto expected = box().behind(from, sphereDirection(i));
    const auto found = walls.behind(from, sphereDirection(i));
    EXPECT_LT(glm::length(found.position - expected.position), 1e-4f);
    EXPECT_LT(glm::length(found.normal - expected.normal), 1e-5f);
    EXPECT_TRUE(walls.isSeen(found.position, from));
  }
}

TEST(Room, AnOpeningShowsTheDistantProbe) {
  const Room walls(boxModel(false, Furniture::None), kCapture, "test");
  const Surroundings surroundings = room();
  const Probe probe(gradientProbe({32, 16}, Rgb(0.3f), {0.2, 0.6, 0.3}));
  const FiniteSurroundings lighting(makeStrategy("importance", probe, Mis::Balance, "test"), probe,
                                    surroundings, &walls);
  const vec3 up = glm::normalize(vec3(0.1f, 1, -0.2f)), down(0, -1, 0);
  const vec3 from(-1.5f, 1, 1);
  EXPECT_LT(glm::length(lighting.background(from, up) - probe.radiance(up)), 1e-4f);
  EXPECT_GT(glm::length(lighting.background(from, down) - probe.radiance(down)), 1e-3f);
}

TEST(Room, AScreenOccludesTheWallBehindIt) {
  const Room walls(boxModel(true, Furniture::Screen), kCapture, "test");
  const vec3 corner(-1.99f, 0.5f, 1.5f);
  EXPECT_FALSE(walls.isSeen(corner, kCapture));
  EXPECT_TRUE(walls.isSeen(corner, {-1.9f, 0.5f, 0}));
  EXPECT_TRUE(walls.isSeen({-1, 0.5f, 1}, kCapture)) << "a point on the screen";
}

// A screen of glass, of half coverage or cut out is a wall as any other.
TEST(Room, MaterialsOfTheModelDoNotMatter) {
  const Scene opaque = boxModel(true, Furniture::Screen);
  Material glass = lambert(Rgb(1));
  glass.extended.emplace().transmission = 1;
  glass.extended->thinWalled = true;
  Material blended = lambert(Rgb(1)), cut = lambert(Rgb(1));
  blended.alphaMode = AlphaMode::Blend;
  cut.alphaMode = AlphaMode::Mask;
  blended.baseColor.w = cut.baseColor.w = 0.25f;
  cut.alphaCutoff = 0.5f;
  const Room expected(opaque, kCapture, "test");
  for (const Material& material : {glass, blended, cut}) {
    Scene model = opaque;
    model.materials.front() = material;
    const Room walls(std::move(model), kCapture, "test");
    for (uint64_t i = 0; i < 200; ++i) {
      const vec3 from = kCapture + 0.5f * sphereDirection(i + 1000);
      const auto wall = expected.behind(from, sphereDirection(i));
      EXPECT_EQ(walls.behind(from, sphereDirection(i)).position, wall.position);
      EXPECT_TRUE(walls.isSeen(wall.position, from));
    }
    EXPECT_FALSE(walls.isSeen({-1.99f, 0.5f, 1.5f}, kCapture));
  }
}

// The floor on both sides of the screen is also lit by walls that the capture point cannot see.
// BSDF samples do not depend on visibility from the capture point; light samples must agree.
TEST(SlowRoom, StrategiesAgreeWhenWallsOccludeEachOther) {
  const Probe probe(spotted(), 25);
  const Room walls(boxModel(true, Furniture::Screen), kCapture, "test");
  const Surroundings surroundings = room();
  const auto lighting = [&](const char* name) {
    return FiniteSurroundings(makeStrategy(name, probe, Mis::Balance, "test"), probe, surroundings,
                              &walls);
  };
  for (const vec2 at : {vec2(0.5f, -0.5f), vec2(-1.5f, 1.2f), vec2(-0.6f, 1)}) {
    const Moments expected = floorRadiance(lighting("bsdf"), at.x, at.y, 8);
    for (const char* name : {"uniform", "importance"}) {
      const Moments found = floorRadiance(lighting(name), at.x, at.y, 8);
      EXPECT_GT(welchTest(found, expected), sidak(1e-3, 6)) << name << " at " << at.x;
      EXPECT_NEAR(found.mean / expected.mean, 1, 0.03);
    }
  }
}

TEST(Room, RejectsEmptyModelsAndCapturePointsOutside) {
  EXPECT_THROW(Room(Scene(), kCapture, "test"), InputError);
  EXPECT_THROW(Room(boxModel(true, Furniture::None), {0, 5, 0}, "test"), InputError);
}

}  // namespace
}  // namespace chromeball::room_test

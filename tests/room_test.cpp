// Surroundings that are a model of the room.
#include "trace/room.h"

#include <gtest/gtest.h>

#include "lighting/finite_surroundings.h"
#include "math/error.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {
namespace {

const vec3 kMin(-2, 0, -3), kMax(3, 2.5f, 2), kCapture(0.5f, 1, -0.5f);

Surroundings describedBy(Surroundings::Shape shape) {
  Surroundings s;
  s.shape = shape;
  s.min = kMin, s.max = kMax, s.capture = kCapture;
  return s;
}

enum class Furnishing { None, Screen };

// The box as a mesh; its walls' fronts face either way. The screen hides a corner from the capture
// point.
Scene boxModel(bool hasCeiling, Furnishing furnishing) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.5f)));
  const vec3 size = kMax - kMin, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  addQuad(scene, grey, kMin, z, x);
  addQuad(scene, grey, kMin, x, y);
  addQuad(scene, grey, kMin, y, z);
  addQuad(scene, grey, kMax, -x, -y);
  addQuad(scene, grey, kMax, -y, -z);
  if (hasCeiling) addQuad(scene, grey, kMax, -z, -x);
  if (furnishing == Furnishing::Screen)
    addQuad(scene, grey, {-1, 0, 0.6f}, {0, 2, 0}, {0, 0, 1.4f});
  return scene;
}

Image spotted() {
  Image probe = gradientProbe({32, 16}, Rgb(0.3f), {0.2, 0.6, 0.3});
  probe.setRgb(12, 4, Rgb(60, 40, 30));
  return probe;
}

vec3 sphereDirection(uint64_t i) {
  return squareToUniformSphere({toUnit(uint32_t(hash(2 * i))), toUnit(uint32_t(hash(2 * i + 1)))});
}

TEST(Room, AModelOfABoxIsTheBox) {
  const Surroundings box = describedBy(Surroundings::Shape::Box);
  const Room room(boxModel(true, Furnishing::None), kCapture, "test");
  for (uint64_t i = 0; i < 1000; ++i) {
    const vec3 from = kCapture + 0.9f * toUnit(uint32_t(hash(i, 7))) * sphereDirection(i + 1000);
    const auto expected = box.behind(from, sphereDirection(i));
    const auto found = room.behind(from, sphereDirection(i));
    EXPECT_LT(glm::length(found.position - expected.position), 1e-4f);
    EXPECT_LT(glm::length(found.normal - expected.normal), 1e-5f);
    EXPECT_TRUE(room.isSeen(found.position, from));
  }
}

TEST(Room, AnOpeningShowsTheDistantProbe) {
  const Room room(boxModel(false, Furnishing::None), kCapture, "test");
  const Surroundings surroundings = describedBy(Surroundings::Shape::Model);
  const Probe probe(gradientProbe({32, 16}, Rgb(0.3f), {0.2, 0.6, 0.3}));
  const FiniteSurroundings lighting(makeStrategy("importance", probe, Mis::Balance, "test"), probe,
                                    surroundings, &room);
  const vec3 up = glm::normalize(vec3(0.1f, 1, -0.2f)), down(0, -1, 0);
  const vec3 from(-1.5f, 1, 1);
  EXPECT_LT(glm::length(lighting.background(from, up) - probe.radiance(up)), 1e-4f);
  EXPECT_GT(glm::length(lighting.background(from, down) - probe.radiance(down)), 1e-3f);
}

TEST(Room, AScreenHidesWhatIsBehind) {
  const Room room(boxModel(true, Furnishing::Screen), kCapture, "test");
  const vec3 corner(-1.99f, 0.5f, 1.5f);
  EXPECT_FALSE(room.isSeen(corner, kCapture));
  EXPECT_TRUE(room.isSeen(corner, {-1.9f, 0.5f, 0}));
  EXPECT_TRUE(room.isSeen({-1, 0.5f, 1}, kCapture)) << "a point of the screen itself";
}

Moments floorRadiance(const LightingStrategy& lighting, float x, float z) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-1.9f, 0, 1.9f}, {3.8f, 0, 0},
          {0, 0, -3.8f});
  const Accel accel(scene);
  const std::atomic<bool> stop = false;
  const Camera camera = Camera::lookAt({x, 1.5f, z}, {x, 0, z}, {0, 0, -1}, 0.02f);
  std::vector<double> means;
  for (uint64_t seed = 0; seed < 8; ++seed)
    means.push_back(luminance(meanColor(
        render(
            scene, accel, camera, lighting, smallRender(4, 4, 512, 1, seed), [](double) {}, stop)
            .film.mean())));
  return Moments::of(means);
}

// The floor before and behind the screen, which is lit by what the capture point does not see as
// well: BSDF samples, which know no visibility but their own, must agree with light samples.
TEST(SlowRoom, StrategiesAgreeThoughWallsHideEachOther) {
  const Probe probe(spotted(), 25);
  const Room room(boxModel(true, Furnishing::Screen), kCapture, "test");
  const Surroundings surroundings = describedBy(Surroundings::Shape::Model);
  const auto lighting = [&](const char* name) {
    return FiniteSurroundings(makeStrategy(name, probe, Mis::Balance, "test"), probe, surroundings,
                              &room);
  };
  for (const vec2 at : {vec2(0.5f, -0.5f), vec2(-1.5f, 1.2f), vec2(-0.6f, 1)}) {
    const Moments expected = floorRadiance(lighting("bsdf"), at.x, at.y);
    for (const char* name : {"uniform", "importance"}) {
      const Moments found = floorRadiance(lighting(name), at.x, at.y);
      EXPECT_GT(welchTest(found, expected), sidak(1e-3, 6)) << name << " at " << at.x;
      EXPECT_NEAR(found.mean / expected.mean, 1, 0.03);
    }
  }
}

TEST(Room, RefusesWhatIsNone) {
  EXPECT_THROW(Room(Scene(), kCapture, "test"), InputError);
  EXPECT_THROW(Room(boxModel(true, Furnishing::None), {0, 5, 0}, "test"), InputError);
}

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Where automatic cameras look from: a given direction, a node, or what suits the shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "scene/bounds.h"
#include "scene/framing.h"
#include "test_scene.h"

namespace chromeball::view_test {
namespace {

constexpr float kAspect = 1.5f;

Scene empty() {
  Scene scene;
  Material material = lambert(Rgb(0.5f));
  material.doubleSided = false;
  addMaterial(scene, material);
  return scene;
}

// Six quads with fronts outside, or inside.
void addBox(Scene& scene, vec3 low, vec3 high, bool inwards = false) {
  const vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  const auto quad = [&](vec3 corner, vec3 a, vec3 b) {
    inwards ? addQuad(scene, 0, corner, b, a) : addQuad(scene, 0, corner, a, b);
  };
  quad(low, x, z);
  quad(low, y, x);
  quad(low, z, y);
  quad(high, -z, -x);
  quad(high, -x, -y);
  quad(high, -y, -z);
}

// A tube around the vertical with this radius at each height, closed by discs where it is 0; it
// faces outwards where the profile rises.
void addTurned(Scene& scene, vec3 foot, const std::vector<vec2>& profile) {
  constexpr uint32_t kAround = 48;
  Mesh mesh;
  for (const vec2& p : profile)
    for (uint32_t i = 0; i < kAround; ++i) {
      const float angle = 2 * kPi * float(i) / kAround;
      mesh.positions.push_back(foot + vec3(p.x * std::sin(angle), p.y, p.x * std::cos(angle)));
    }
  for (uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
    for (uint32_t i = 0; i < kAround; ++i) {
      const uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, b, a + kAround});
      mesh.triangles.push_back({b, b + kAround, a + kAround});
    }
  addMesh(scene, 0, mesh);
}

void turnInsideOut(Scene& scene) {
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    for (Triangle& t : scene.meshes.edit(i).triangles) std::swap(t[1], t[2]);
}

// Whether all vertices are in view.
bool shows(const Camera& camera, const Scene& scene) {
  const CameraView view(camera, kAspect);
  return std::ranges::all_of(scene.instances, [&](const Instance& instance) {
    const auto& points = scene.meshes[size_t(instance.mesh)].positions;
    return std::ranges::all_of(points, [&](const vec3& p) {
      const auto at = view.at(glm::dvec3(instance.point(p)));
      return at && at->position.x >= 0 && at->position.x <= 1 && at->position.y >= 0 &&
             at->position.y <= 1;
    });
  });
}

void expectAxis(const vec3& axis, const vec3& expected, const std::string& what) {
  EXPECT_LT(glm::distance(axis, expected), 1e-5f)
      << what << ": " << axis.x << " " << axis.y << " " << axis.z;
}

TEST(View, AnglesAreAzimuthElevationAndRoll) {
  Scene scene = empty();
  addBox(scene, vec3(-1), vec3(1, 2, 3));
  const auto seen = [&](ViewAngles angles) {
    const Camera camera = framingCamera(scene, kAspect, {.angles = angles});
    EXPECT_TRUE(shows(camera, scene));
    EXPECT_LT(glm::distance(glm::cross(camera.right, camera.up), camera.back), 1e-5f);
    return camera;
  };
  expectAxis(seen({0, 0}).back, {0, 0, 1}, "the front");
  expectAxis(seen({90, 0}).back, {1, 0, 0}, "the right");
  expectAxis(seen({0, 90}).back, {0, 1, 0}, "above");
  expectAxis(seen({0, 90}).up, {0, 0, -1}, "up in a view from above");
  expectAxis(seen({90, -90}).up, {1, 0, 0}, "up in a view from below");
  const vec3 back = seen({30, 45}).back;
  expectAxis(back, std::sqrt(0.5f) * vec3(0.5f, 1, std::sqrt(0.75f)), "both");
  expectAxis(seen({0, 0, 90}).up, {-1, 0, 0}, "a quarter turn of the camera to its left");
}

TEST(View, AWiderFieldOfViewStandsNearer) {
  Scene scene = empty();
  addBox(scene, vec3(-1), vec3(1));
  const Camera near = framingCamera(scene, kAspect, {.fov = 1.2}),
               far = framingCamera(scene, kAspect, {.fov = 0.2});
  EXPECT_FLOAT_EQ(near.fov, 1.2f);
  EXPECT_LT(glm::length(near.position), 0.5f * glm::length(far.position));
  EXPECT_TRUE(shows(near, scene) && shows(far, scene));
}

TEST(View, ANodeAndThoseBelowItAreFramed) {
  Scene scene = empty(), part = empty();
  addBox(scene, vec3(-9), vec3(9));
  addBox(part, vec3(10), vec3(11));
  const size_t first = scene.instances.size();
  append(scene, Scene(part));
  scene.nodeNames = {"room", "lamp", "shade"};
  scene.nodeParents = {-1, -1, 1};
  for (size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].node = i < first ? 0 : i == first ? 1 : 2;
  EXPECT_EQ(instancesBelow(scene, "lamp").size(), part.instances.size());
  const Camera camera = framingCamera(scene, kAspect, {.node = "lamp"});
  EXPECT_EQ(camera.position, framingCamera(part, kAspect).position);
  EXPECT_FALSE(shows(camera, scene));
}

TEST(View, OtherTimesAreInViewToo) {
  Scene start = empty(), later = empty();
  addBox(start, vec3(-1), vec3(1));
  addBox(later, vec3(5, -1, 2), vec3(7, 8, 4));
  for (const bool turns : {false, true}) {
    Framing framing(start, kAspect, {.turns = turns});
    EXPECT_FALSE(shows(framing.camera(), later));
    framing.add(later);
    EXPECT_TRUE(shows(framing.camera(), start) && shows(framing.camera(), later)) << turns;
  }
}

// A wide sheet on low legs: as wide as a ground, but above.
TEST(View, ATableTopIsNoGround) {
  Scene table = empty();
  addBox(table, vec3(-0.2f, 0, -0.2f), vec3(0.2f, 0.7f, 0.2f));
  addBox(table, vec3(-2, 0.7f, -2), vec3(2, 0.72f, 2));
  EXPECT_TRUE(shows(framingCamera(table, kAspect), table));
}

TEST(View, ChartsAreSeenFromTheirFront) {
  const auto frontOf = [](vec3 a, vec3 b) {
    Scene chart = empty();
    addQuad(chart, 0, vec3(1, 2, 3), a, b);
    const Camera camera = framingCamera(chart, kAspect);
    EXPECT_TRUE(shows(camera, chart));
    return camera.back;
  };
  expectAxis(frontOf({2, 0, 0}, {0, 1, 0}), {0, 0, 1}, "front");
  expectAxis(frontOf({0, 1, 0}, {2, 0, 0}), {0, 0, -1}, "rear");
  expectAxis(frontOf({0, 1, 0}, {0, 0, 1}), {1, 0, 0}, "side");
  expectAxis(frontOf({0, 0, 1}, {1, 0, 0}), {0, 1, 0}, "lying");
  expectAxis(frontOf({1, 0, 0}, {0, 1, -1}), std::sqrt(0.5f) * vec3(0, 1, 1), "desk");
}

// A board with samples that stand out from it.
TEST(View, BoardsAreSeenFromTheirFront) {
  Scene board = empty();
  addBox(board, vec3(-1, -1, -0.2f), vec3(1, 1, -0.1f));
  for (int i = 0; i < 9; ++i)
    addSphere(board, 0, vec3(0.6f * float(i % 3 - 1), 0.6f * float(i / 3 - 1), 0), 0.2f, 8);
  expectAxis(framingCamera(board, kAspect).back, {0, 0, 1}, "board");
}

TEST(View, RowsAreSeenFromTheirSide) {
  Scene row = empty();
  for (int i = 0; i < 7; ++i) addSphere(row, 0, vec3(0, 1, 2 * i), 1, 8);
  EXPECT_GT(framingCamera(row, kAspect).back.x, 0.8f);
}

// A cup in a row of large shapes surrounds a free position, and is no room with furniture.
TEST(View, ARowWithACupIsSeenFromOutside) {
  Scene row = empty();
  for (int i = 0; i < 6; ++i) addSphere(row, 0, vec3(2 * i, 1.25f, 0), 1, 8);
  addTurned(row, vec3(-2.5f, 0, 0),
            {{0, 0}, {1.3f, 0}, {1.3f, 2.5f}, {1.2f, 2.5f}, {1.2f, 0.1f}, {0, 0.1f}});
  EXPECT_TRUE(shows(framingCamera(row, kAspect), row));
}

// Bodies with a flat base and upright sides, whose fronts are inside.
TEST(View, BottlesAndTrunksTurnedInsideOutAreSeenFromOutside) {
  Scene bottle = empty();
  addTurned(bottle, vec3(0), {{0, 0}, {1, 0}, {1, 3}, {0.3f, 4}, {0, 4}});
  Scene figure = empty();
  addBox(figure, vec3(-0.5f, 2, -0.3f), vec3(0.5f, 4, 0.3f));
  for (const float x : {-1.0f, 1.0f}) {
    addBox(figure, vec3(x * 1.5f - 1, 3.5f, -0.1f), vec3(x * 1.5f + 1, 3.7f, 0.1f));
    addBox(figure, vec3(0.3f * x - 0.1f, 0, -0.9f), vec3(0.3f * x + 0.1f, 2, -0.7f));
  }
  for (Scene* scene : {&bottle, &figure}) {
    turnInsideOut(*scene);
    const Framing framing(*scene, kAspect);
    EXPECT_TRUE(shows(framing.camera(), *scene)) << (scene == &bottle ? "bottle" : "figure");
    EXPECT_TRUE(framing.isDark());
  }
}

// A box of two faces, with the front (+z) open, turned about the vertical by quarters.
TEST(View, OpenBoxesAreSeenThroughTheirOpenSide) {
  for (const bool isClosedAbove : {false, true})
    for (int quarter = 0; quarter < 4; ++quarter) {
      Scene box = empty();
      addBox(box, {-2, 0, -2}, {2, 0.1f, 2});
      addBox(box, {-2, 0, -2}, {2, 3, -1.9f});
      addBox(box, {-2, 0, -2}, {-1.9f, 3, 2});
      addBox(box, {1.9f, 0, -2}, {2, 3, 2});
      if (isClosedAbove) addBox(box, {-2, 2.9f, -2}, {2, 3, 2});
      for (Instance& instance : box.instances) {
        instance.toWorld.emplace();
        instance.toWorld->linear =
            glm::mat3_cast(glm::angleAxis(0.5f * kPi * float(quarter), vec3(0, 1, 0)));
      }
      const Framing framing(box, kAspect);
      const vec3 back = framing.camera().back, open(quarter == 1   ? 1
                                                    : quarter == 3 ? -1
                                                                   : 0,
                                                    0,
                                                    quarter == 0   ? 1
                                                    : quarter == 2 ? -1
                                                                   : 0);
      EXPECT_GT(glm::dot(back, open), isClosedAbove ? 0.999f : 0.9f) << quarter;
      EXPECT_FALSE(framing.isDark());
    }
}

// A yard with walls of two faces, three times as large as the furnished room beside it.
Scene houseWithYard(bool hasWindow) {
  Scene house = empty();
  addBox(house, {-5, -0.2f, -4}, {5, 0, 11});
  addBox(house, {-5, 0, -4.2f}, {5, 3, -4});
  addBox(house, {-5, 0, 11}, {5, 3, 11.2f});
  addBox(house, {-5.2f, 0, -4}, {-5, 3, 11});
  addBox(house, {5, 0, -4}, {5.2f, 3, 11});
  if (hasWindow) {
    addBox(house, {-5, 0, 0}, {-3, 3, 0.2f});
    addBox(house, {3, 0, 0}, {5, 3, 0.2f});
    addBox(house, {-3, 0, 0}, {3, 0.5f, 0.2f});
    addBox(house, {-3, 2.5f, 0}, {3, 3, 0.2f});
  } else {
    addBox(house, {-5, 0, 0}, {5, 3, 0.2f});
  }
  addBox(house, {-5, 3, -4}, {5, 3.2f, 0.2f});
  for (int i = 0; i < 3; ++i) addBox(house, {3 - 3 * i, 0, -3.8f}, {4 - 3 * i, 1, -3});
  return house;
}

TEST(View, RoomsUnderARoofAreSeenRatherThanYards) {
  const vec3 eye = framingCamera(houseWithYard(false), kAspect).position;
  EXPECT_TRUE(eye.z < 0 && eye.z > -4) << eye.z;
}

// Along the room, where a window on its long side shows more.
TEST(View, RoomsAreSeenRatherThanTheirWindows) {
  const Camera camera = framingCamera(houseWithYard(true), kAspect);
  EXPECT_TRUE(camera.position.z < 0 && camera.position.z > -4) << camera.position.z;
  EXPECT_GT(std::fabs(camera.back.x), 0.8f);
}

// The eye is above the floor that it stands on, not above the cellar.
TEST(View, TheEyesHeightIsThatWithinTheRoom) {
  Scene house = empty();
  addBox(house, {0, -3, 0}, {8, -2.9f, 5});
  addBox(house, {0, 0, 0}, {8, 3, 5}, true);
  addBox(house, {1, -3, 1}, {2, -0.1f, 2});
  for (int i = 0; i < 4; ++i) addBox(house, {1 + i, 0, 4}, {1.5f + i, 0.5f, 4.5f});
  const vec3 eye = framingCamera(house, kAspect).position;
  EXPECT_TRUE(eye.x > 0 && eye.x < 8 && eye.z > 0 && eye.z < 5);
  EXPECT_TRUE(eye.y > 1 && eye.y < 2) << eye.y;
}

// Closed walls that face inwards keep a probe's light out, unless they have two sides or a window.
TEST(View, ClosedRoomsAreDark) {
  const auto isDark = [](bool isDoubleSided, bool hasWindow, const ViewWishes& wishes) {
    Scene room = empty();
    room.materials[0].doubleSided = isDoubleSided;
    addBox(room, {0, 0, 0}, {8, 3, 5}, true);
    if (hasWindow) {
      room.meshes.pop_back(), room.instances.pop_back();
      addQuad(room, 0, {8, 0, 0}, {0, 1, 0}, {0, 0, 5});
    }
    return Framing(room, kAspect, wishes).isDark();
  };
  EXPECT_TRUE(isDark(false, false, {}));
  EXPECT_TRUE(isDark(false, false, {.angles = ViewAngles{10, 20}}));
  EXPECT_FALSE(isDark(true, false, {}));
  EXPECT_FALSE(isDark(false, true, {}));
}

// So do those around a node that is looked at, but not those beside it.
TEST(View, NodesInClosedRoomsAreDark) {
  const auto isDark = [](bool hasWindow, float x, const char* node) {
    Scene room = empty();
    room.nodeNames = {"room", "table"};
    addBox(room, {0, 0, 0}, {8, 3, 5}, true);
    if (hasWindow) room.meshes.pop_back(), room.instances.pop_back();
    const size_t walls = room.instances.size();
    addBox(room, {x, 0, 2}, {x + 2, 1, 3});
    for (size_t i = walls; i < room.instances.size(); ++i) room.instances[i].node = 1;
    return Framing(room, kAspect, {.node = node}).isDark();
  };
  EXPECT_TRUE(isDark(false, 3, "table"));
  EXPECT_TRUE(isDark(false, 3, "room"));
  EXPECT_FALSE(isDark(true, 3, "table"));
  EXPECT_FALSE(isDark(false, 20, "table"));
}

}  // namespace
}  // namespace chromeball::view_test

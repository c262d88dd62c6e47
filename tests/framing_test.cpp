// SPDX-License-Identifier: Apache-2.0
// Cameras for scenes without one: ground planes are not framed, rooms are viewed from inside.
#include "scene/framing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "test_scene.h"

namespace chromeball::framing_test {
namespace {

constexpr float kAspect = 1.5f;

// Projects a position to the image: u right and v down, both in [0, 1].
vec2 project(const Camera& camera, const vec3& point) {
  const vec3 q = point - camera.position;
  const float depth = -glm::dot(q, camera.back), half = std::tan(0.5f * camera.fov);
  return {0.5f + 0.5f * glm::dot(q, camera.right) / (depth * half * kAspect),
          0.5f - 0.5f * glm::dot(q, camera.up) / (depth * half)};
}

// The fraction of the image's width or height that a mesh covers, whichever is larger; 0 if a part
// of it is out of view.
float imageFraction(const Camera& camera, const Mesh& mesh) {
  vec2 minimum(1e9f), maximum(-1e9f);
  for (const vec3& p : mesh.positions) {
    if (glm::dot(p - camera.position, camera.back) >= 0) return 0;
    minimum = glm::min(minimum, project(camera, p));
    maximum = glm::max(maximum, project(camera, p));
  }
  if (std::min(minimum.x, minimum.y) < 0 || std::max(maximum.x, maximum.y) > 1) return 0;
  return std::max(maximum.x - minimum.x, maximum.y - minimum.y);
}

Scene ball() {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), vec3(0, 1, 0), 1);
  return scene;
}

void addGround(Scene& scene, vec2 from, float size) {
  addQuad(scene, 0, vec3(from.x, 0, from.y), vec3(0, 0, size), vec3(size, 0, 0));
}

TEST(Framing, GroundsOfAnySizeAndNumberOfTilesAreNotFramed) {
  Scene scene = ball();
  const Camera alone = framingCamera(scene, kAspect);
  EXPECT_GT(imageFraction(alone, scene.meshes[0]), 0.9f);
  for (const float size : {20.0f, 100.0f, 10000.0f}) {
    Scene grounded = ball();
    addGround(grounded, vec2(-size / 2), size);
    EXPECT_EQ(framingCamera(grounded, kAspect).position, alone.position) << size;
  }
  for (int x = -5; x < 5; ++x)
    for (int z = -5; z < 5; ++z) addGround(scene, 10.0f * vec2(x, z), 10);
  EXPECT_GT(imageFraction(framingCamera(scene, kAspect), scene.meshes[0]), 0.5f);
}

TEST(Framing, FlatObjectsOtherThanGroundsAreFramed) {
  Scene board = ball();  // a ball on a board twice as wide
  addGround(board, vec2(-2), 4);
  EXPECT_GT(imageFraction(framingCamera(board, kAspect), board.meshes[1]), 0.7f);
  Scene flat;  // a board without anything on it
  addMaterial(flat, lambert(Rgb(0.5f)));
  addGround(flat, vec2(-50), 100);
  EXPECT_GT(imageFraction(framingCamera(flat, kAspect), flat.meshes[0]), 0.7f);
}

// Walls, floor and ceiling of a room with the given outline (counter-clockwise seen from above),
// with front faces inside.
Scene room(const std::vector<vec2>& outline, float height, bool inwards = true) {
  Scene scene;
  addMaterial(scene, lambert(Rgb(0.5f)));
  const auto quad = [&](vec3 corner, vec3 a, vec3 b) {
    inwards ? addQuad(scene, 0, corner, a, b) : addQuad(scene, 0, corner, b, a);
  };
  for (size_t i = 0; i < outline.size(); ++i) {
    const vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    quad(vec3(a.x, 0, a.y), vec3(0, height, 0), vec3(b.x - a.x, 0, b.y - a.y));
  }
  return scene;
}

void addFloorAndCeiling(Scene& scene, vec2 from, vec2 size, float height) {
  addQuad(scene, 0, vec3(from.x, 0, from.y), vec3(0, 0, size.y), vec3(size.x, 0, 0));
  addQuad(scene, 0, vec3(from.x, height, from.y), vec3(size.x, 0, 0), vec3(0, 0, size.y));
}

const std::vector<vec2> kHall{{0, 0}, {0, 5}, {8, 5}, {8, 0}};  // 8 m along x, 5 m along z

TEST(Framing, RoomsAreSeenFromInsideAlongTheirLength) {
  for (const float size : {0.01f, 1.0f, 100.0f}) {
    Scene hall = room(kHall, 3);
    addFloorAndCeiling(hall, vec2(0), vec2(8, 5), 3);
    addSphere(hall, 0, vec3(4, 0.5f, 2.5f), 0.5f);  // furniture, with front faces outside
    for (size_t i = 0; i < hall.meshes.size(); ++i)
      for (vec3& p : hall.meshes.edit(i).positions) p *= size;
    const Camera camera = framingCamera(hall, kAspect);
    const vec3 eye = camera.position / size;
    EXPECT_TRUE(eye.x > 0 && eye.x < 8 && eye.z > 0 && eye.z < 5) << eye.x << " " << eye.z;
    EXPECT_TRUE(eye.y > 1 && eye.y < 2.2f) << eye.y;
    const float wall = camera.back.x < 0 ? 8 - eye.x : eye.x;
    EXPECT_GT(wall, 6) << "must look at the far wall";
    EXPECT_GT(std::fabs(camera.back.x), 0.7f);
    EXPECT_NEAR(camera.right.y, 0, 1e-6f);
  }
}

TEST(Framing, HousesAreSeenFromOutside) {
  Scene house = room(kHall, 3, false);
  const Camera camera = framingCamera(house, kAspect);
  const vec3 eye = camera.position;
  EXPECT_TRUE(eye.x < 0 || eye.x > 8 || eye.z < 0 || eye.z > 5);
}

TEST(Framing, ThePositionIsInsideRoomsThatAreNotBoxes) {
  // An L; the notch x > 3, z < 6 is outside.
  Scene corner = room({{0, 0}, {0, 9}, {9, 9}, {9, 6}, {3, 6}, {3, 0}}, 3);
  addFloorAndCeiling(corner, vec2(0), vec2(3, 9), 3);
  addFloorAndCeiling(corner, vec2(3, 6), vec2(6, 3), 3);
  const vec3 eye = framingCamera(corner, kAspect).position;
  EXPECT_TRUE(eye.x > 0 && eye.z < 9 && eye.x < 9 && eye.z > 0);
  EXPECT_TRUE(eye.x < 3 || eye.z > 6) << eye.x << " " << eye.z;
}

TEST(Framing, MirroredInstancesKeepTheirFrontFaces) {
  Scene hall = room(kHall, 3);
  addFloorAndCeiling(hall, vec2(0), vec2(8, 5), 3);
  for (Instance& instance : hall.instances) {
    instance.toWorld = Transform();
    instance.toWorld->linear[0][0] = -1;
  }
  const vec3 eye = framingCamera(hall, kAspect).position;
  EXPECT_TRUE(eye.x < 0 && eye.x > -8 && eye.z > 0 && eye.z < 5) << eye.x << " " << eye.z;
}

// Walls with inner and outer faces, 0.2 m thick, around `furniture` balls, without a ceiling.
Scene doubleWalls(int furniture, float scale) {
  Scene scene = room(kHall, 3);
  const Scene outer = room({{-0.2f, -0.2f}, {-0.2f, 5.2f}, {8.2f, 5.2f}, {8.2f, -0.2f}}, 3, false);
  for (const Mesh& mesh : outer.meshes) addMesh(scene, 0, mesh);
  addQuad(scene, 0, vec3(0), vec3(0, 0, 5), vec3(8, 0, 0));
  Mesh shell;  // walls and floor as a single mesh
  for (const Mesh& mesh : scene.meshes) {
    const uint32_t first = uint32_t(shell.positions.size());
    shell.positions.insert(shell.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles) shell.triangles.push_back(t + first);
  }
  scene.meshes = MeshList(shell);
  scene.instances.resize(1);
  for (int i = 0; i < furniture; ++i) addSphere(scene, 0, vec3(1 + i, 0.4f, 4), 0.4f, 8);
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    for (vec3& p : scene.meshes.edit(i).positions) p *= scale;
  return scene;
}

TEST(Framing, FurnishedRoomsAreSeenFromInsideAndCupsFromOutside) {
  const auto isInside = [](const Scene& scene, float scale) {
    const vec3 eye = framingCamera(scene, kAspect).position / scale;
    return eye.x > 0 && eye.x < 8 && eye.z > 0 && eye.z < 5 && eye.y > 0 && eye.y < 3;
  };
  EXPECT_TRUE(isInside(doubleWalls(5, 1), 1));
  EXPECT_FALSE(isInside(doubleWalls(0, 1), 1)) << "an empty box";
  EXPECT_FALSE(isInside(doubleWalls(5, 0.02f), 0.02f)) << "a small box, 16 cm long";
}

// Whether all of the scene is in view.
bool isSeenFromOutside(const Scene& scene) {
  const Camera camera = framingCamera(scene, kAspect);
  return std::ranges::all_of(scene.instances, [&](const Instance& instance) {
    return imageFraction(camera, scene.meshes[size_t(instance.mesh)]) > 0;
  });
}

// This holds at any depth: seen from far away, the opening has a window's angle.
TEST(Framing, OpenBoxesAreSeenFromOutside) {
  for (const float depth : {5.0f, 10.0f, 20.0f, 40.0f}) {
    Scene box = room({{5, depth}, {5, 0}, {0, 0}, {0, depth}}, 5);
    box.meshes.pop_back(), box.instances.pop_back();  // the front, at z = depth, is open
    addFloorAndCeiling(box, vec2(0), vec2(5, depth), 5);
    EXPECT_GT(framingCamera(box, kAspect).position.z, depth);
    for (const int furniture : {1, 6}) {
      Scene furnished = box;
      for (int i = 0; i < furniture; ++i)
        addSphere(furnished, 0, vec3(1 + i % 3, 0.5f, 1 + i / 3), 0.5f, 8);
      EXPECT_TRUE(isSeenFromOutside(furnished)) << depth << " " << furniture;
    }
  }
}

// A stage of two or three walls with two faces each, and furniture in front of its open sides.
TEST(Framing, DioramasAreSeenFromOutside) {
  for (const int walls : {2, 3})
    for (const float depth : {4.0f, 8.0f}) {
      Scene stage;
      addMaterial(stage, lambert(Rgb(0.5f)));
      const auto block = [&](vec3 corner, vec3 size) {
        Scene part = room({{corner.x, corner.z},
                           {corner.x + size.x, corner.z},
                           {corner.x + size.x, corner.z + size.z},
                           {corner.x, corner.z + size.z}},
                          size.y);
        for (Mesh mesh : part.meshes) {
          for (vec3& p : mesh.positions) p.y += corner.y;
          addMesh(stage, 0, mesh);
        }
        addQuad(stage, 0, corner + vec3(0, size.y, 0), vec3(0, 0, size.z), vec3(size.x, 0, 0));
      };
      block({0, -0.1f, 0}, {4, 0.1f, depth});
      block({0, 0, 0}, {4, 2.5f, 0.1f});
      block({0, 0, 0}, {0.1f, 2.5f, depth});
      if (walls == 3) block({3.9f, 0, 0}, {0.1f, 2.5f, depth});
      for (int i = 0; i < 4; ++i) block({0.2f + i, 0, depth - 0.5f}, {0.7f, 1.6f, 0.4f});
      EXPECT_TRUE(isSeenFromOutside(stage)) << walls << " " << depth;
    }
}

void addTorus(Scene& scene, vec3 centre, float radius, float tube) {
  constexpr uint32_t kAround = 24, kAcross = 12;
  Mesh mesh;
  for (uint32_t i = 0; i < kAround; ++i)
    for (uint32_t j = 0; j < kAcross; ++j) {
      const float a = 2 * kPi * float(i) / kAround, b = 2 * kPi * float(j) / kAcross;
      const float r = radius + tube * std::cos(b);
      mesh.positions.push_back(centre + vec3(r * std::cos(a), tube * std::sin(b), r * std::sin(a)));
      const uint32_t i1 = (i + 1) % kAround, j1 = (j + 1) % kAcross;
      const auto at = [](uint32_t u, uint32_t v) { return u * kAcross + v; };
      mesh.triangles.push_back({at(i, j), at(i, j1), at(i1, j)});
      mesh.triangles.push_back({at(i1, j), at(i, j1), at(i1, j1)});
    }
  addMesh(scene, 0, mesh);
}

// The hole of a torus is no room, also where others lie around it or a plate closes it below.
TEST(Framing, ToriAreSeenFromOutside) {
  for (const bool hasPlate : {false, true}) {
    Scene row;
    addMaterial(row, lambert(Rgb(0.5f)));
    for (int i = 0; i < 5; ++i) addSphere(row, 0, vec3(2 * i, 0, 0), 1, 8);
    addTorus(row, vec3(-2, 0, 0), 1, 0.25f);
    addTorus(row, vec3(10, 0, 0), 1, 0.25f);
    if (hasPlate) addQuad(row, 0, vec3(-3.3f, -1, -1.3f), vec3(0, 0, 2.6f), vec3(14.6f, 0, 0));
    EXPECT_TRUE(isSeenFromOutside(row)) << hasPlate;
  }
}

// A body whose front faces are inside, which is no room without a floor.
TEST(Framing, BodiesTurnedInsideOutAreSeenFromOutside) {
  Scene creature;
  addMaterial(creature, lambert(Rgb(0.5f)));
  addSphere(creature, 0, vec3(0, 1, 0), 1, 24);
  addSphere(creature, 0, vec3(0, 2.2f, 0.4f), 0.5f, 24);
  for (const float x : {-0.5f, 0.5f}) addSphere(creature, 0, vec3(x, 0.1f, 0.2f), 0.3f, 24);
  for (size_t i = 0; i < creature.meshes.size(); ++i)
    for (Triangle& t : creature.meshes.edit(i).triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(isSeenFromOutside(creature));
}

// Nor are the legs of a table, which have floors: they are too small a part of it.
TEST(Framing, TablesTurnedInsideOutAreSeenFromOutside) {
  for (const float leg : {0.1f, 0.2f}) {
    Scene table;
    addMaterial(table, lambert(Rgb(0.5f)));
    const auto addBox = [&](vec3 low, vec3 high) {  // with front faces inside
      const vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
      addQuad(table, 0, low, z, x);
      addQuad(table, 0, low, x, y);
      addQuad(table, 0, low, y, z);
      addQuad(table, 0, high, -x, -z);
      addQuad(table, 0, high, -y, -x);
      addQuad(table, 0, high, -z, -y);
    };
    addBox({-1, 1, -1}, {1, 1.1f, 1});
    for (const float px : {-0.9f, 0.9f - leg})
      for (const float pz : {-0.9f, 0.9f - leg}) addBox({px, 0, pz}, {px + leg, 1, pz + leg});
    EXPECT_TRUE(isSeenFromOutside(table)) << leg;
  }
}

}  // namespace
}  // namespace chromeball::framing_test

// SPDX-License-Identifier: Apache-2.0
// Triangles of glass with which nothing coincides.
#include "trace/coincidence.h"

#include <gtest/gtest.h>

#include <random>

#include "test_scene.h"

namespace chromeball::lone_triangles_test {
namespace {

Material glass() {
  Material m;
  m.metallic = m.roughness = 0;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = false;
  return m;
}

uint32_t triangleCount(const Scene& scene, uint32_t instance) {
  return uint32_t(scene.meshes[size_t(scene.instances[instance].mesh)].triangles.size());
}

size_t loneOf(const Scene& scene, uint32_t instance) {
  const Accel accel(scene);
  const LoneTriangles lone(accel);
  size_t count = 0;
  for (uint32_t t = 0; t < triangleCount(scene, instance); ++t) {
    count += lone.contains(instance, t);
    EXPECT_EQ(lone.contains(instance, t), lone.contains(instance, t)) << "remembered";
  }
  return count;
}

TEST(LoneTriangles, NeighboursDoNotTouch) {
  for (const float scale : {1e-3f, 1.0f, 1e5f})
    for (const int n : {3, 8, 16}) {
      Scene scene;
      addSphere(scene, addMaterial(scene, glass()), scale * vec3(3, 1, 0), scale, n);
      EXPECT_EQ(loneOf(scene, 0), triangleCount(scene, 0)) << scale << " " << n;
    }
}

// A liquid of the surface of its glass, a wall that crosses it, and one that touches it.
TEST(LoneTriangles, OthersTouch) {
  Scene scene;
  const int material = addMaterial(scene, glass()), wall = addMaterial(scene, lambert(Rgb(1)));
  addSphere(scene, material, vec3(0), 1, 16);
  const size_t all = triangleCount(scene, 0);
  Scene filled = scene;
  addSphere(filled, material, vec3(0), -1, 16);
  EXPECT_EQ(loneOf(filled, 0) + loneOf(filled, 1), 0u);
  Scene crossed = scene;
  addQuad(crossed, wall, {-2, 0.3f, 2}, {4, 0, 0}, {0, 0, -4});
  EXPECT_LT(loneOf(crossed, 0), all);
  EXPECT_GT(loneOf(crossed, 0), all / 2);
  EXPECT_EQ(loneOf(crossed, 1), 0u) << "no glass: not remembered";
  Scene beside = scene;
  addQuad(beside, wall, {-2, 1.001f, 2}, {4, 0, 0}, {0, 0, -4});
  EXPECT_EQ(loneOf(beside, 0), all);
}

TEST(LoneTriangles, OfWhatMovesNoneIsRemembered) {
  Scene scene;
  addSphere(scene, addMaterial(scene, glass()), vec3(0), 1, 4);
  scene.moves = true;
  EXPECT_EQ(loneOf(scene, 0), 0u);
}

// Triangles in few planes and others at random, in two meshes: where one is alone, the search for
// coincident surfaces finds nothing at any of its points.
TEST(LoneTriangles, TheSearchFindsNothingThere) {
  std::mt19937 random(1);
  const auto number = [&](float from, float to) {
    return std::uniform_real_distribution(from, to)(random);
  };
  size_t lone = 0, others = 0, found = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene;
    const int material = addMaterial(scene, glass());
    for (int mesh = 0; mesh < 2; ++mesh) {
      Mesh soup;
      for (uint32_t i = 0; i < 12; ++i) {
        const float plane = round % 3 == 0 ? number(-1, 1) : 0.25f * float(random() % 3);
        for (int corner = 0; corner < 3; ++corner) {
          vec3 p(number(-1, 1), plane, number(-1, 1));
          if (round % 3 == 2) p.y += number(-1, 1) * 1e-6f;
          if (i % 4 == 3) p.y = number(-1, 1);
          soup.positions.push_back(p);
        }
        soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      }
      addMesh(scene, material, soup);
    }
    const Accel accel(scene);
    const LoneTriangles triangles(accel);
    for (uint32_t i = 0; i < 2; ++i)
      for (uint32_t t = 0; t < triangleCount(scene, i); ++t) {
        const bool isLone = triangles.contains(i, t);
        (isLone ? lone : others) += 1;
        for (int k = 0; k < 50; ++k) {
          const vec2 at = squareToTriangle({number(0, 1), number(0, 1)});
          const Surface surface = surfaceAt(scene, scene.instances[i], t, at, {0, 1, 0}, 0);
          const Hit hit{i, t, at, 1};
          const Ray ray{surface.position + vec3(0, 1, 0), {0, -1, 0}};
          accel.forEachCoincident(ray, hit, surface, 0, kAllInstances, [&](const Hit& other) {
            ++found;
            EXPECT_FALSE(isLone) << round << ": " << i << " " << t << " and " << other.instance
                                 << " " << other.triangle;
          });
        }
      }
  }
  EXPECT_GT(lone, 200u);
  EXPECT_GT(others, 200u);
  EXPECT_GT(found, 1000u);
}

}  // namespace
}  // namespace chromeball::lone_triangles_test

#include "scene/camera.h"

#include <gtest/gtest.h>

#include "math/error.h"
#include "scene/scene.h"

namespace chromeball {
namespace {

void expectNear(vec3 a, vec3 b, float tolerance = 1e-6f) {
  EXPECT_NEAR(glm::distance(a, b), 0, tolerance)
      << a.x << " " << a.y << " " << a.z << " vs " << b.x << " " << b.y << " " << b.z;
}

TEST(Camera, CentreRayLooksAlongMinusZ) {
  vec3 origin, direction;
  CameraRays(Camera(), 1.5f).ray(0.5f, 0.5f, origin, direction);
  expectNear(origin, vec3(0));
  expectNear(direction, {0, 0, -1});
}

TEST(Camera, PerspectiveCornersFollowTheFieldOfView) {
  Camera camera;
  camera.fov = kPi / 2;  // half the height at unit distance is 1
  vec3 origin, direction;
  CameraRays(camera, 2).ray(0, 0, origin, direction);  // top left
  expectNear(direction, glm::normalize(vec3(-2, 1, -1)));
  CameraRays(camera, 2).ray(1, 1, origin, direction);
  expectNear(direction, glm::normalize(vec3(2, -1, -1)));
}

TEST(Camera, OrthographicRaysAreParallel) {
  Camera camera;
  camera.orthographic = true;
  camera.halfHeight = 3;
  camera.position = {1, 1, 1};
  vec3 origin, direction;
  CameraRays(camera, 2).ray(1, 0, origin, direction);  // top right
  expectNear(origin, {7, 4, 1});
  expectNear(direction, {0, 0, -1});
}

TEST(Camera, LookAtIsOrthonormalAndAims) {
  const Camera camera = Camera::lookAt({3, 4, 5}, {-1, 2, 0.5f}, {0, 2, 0}, 0.8f);
  expectNear(-camera.back, glm::normalize(vec3(-4, -2, -4.5f)));
  expectNear(glm::cross(camera.right, camera.up), camera.back);
  EXPECT_NEAR(glm::length(camera.up), 1, 1e-6f);
  EXPECT_NEAR(camera.right.y, 0, 1e-6f);  // the horizon is level
  EXPECT_GT(camera.up.y, 0);
  EXPECT_EQ(camera.fov, 0.8f);
}

TEST(Camera, LookAtRefusesDegenerateFrames) {
  EXPECT_THROW(Camera::lookAt({1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 1), InputError);
  EXPECT_THROW(Camera::lookAt({0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1), InputError);
  EXPECT_THROW(Camera::lookAt({0, 5, 0}, {1, 0, 0}, {0, 0, 0}, 1), InputError);
}

// Where a point falls in the picture; (0.5, 0.5) is the centre.
vec2 project(const Camera& camera, vec3 p, float aspect) {
  const vec3 q = p - camera.position;
  const float depth = -glm::dot(q, camera.back);
  EXPECT_GT(depth, 0);
  const float tanHalf = std::tan(camera.fov / 2);
  return {0.5f + 0.5f * glm::dot(q, camera.right) / (depth * tanHalf * aspect),
          0.5f - 0.5f * glm::dot(q, camera.up) / (depth * tanHalf)};
}

TEST(Camera, FramingShowsAllOfTheBoundsAndFillsThePicture) {
  for (const float aspect : {0.4f, 1.0f, 2.5f})
    for (const float size : {1e-3f, 1.0f, 1e4f})
      for (const vec3 shape : {vec3(1, 1, 1), vec3(10, 1, 1), vec3(1, 10, 0), vec3(0, 1, 10)}) {
        const vec3 centre = size * vec3(3, -2, 1);
        const Bounds box{centre - size * shape, centre + size * shape};
        const Camera camera = framingCamera(box, aspect);
        EXPECT_GT(camera.back.z, 0.8f);  // from the front, above, from the right
        EXPECT_GT(camera.back.y, 0);
        EXPECT_GT(camera.back.x, 0);
        float widest = 0;
        for (int i = 0; i < 8; ++i) {
          const vec3 corner{i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                            i & 4 ? box.max.z : box.min.z};
          const vec2 off = glm::abs(project(camera, corner, aspect) - vec2(0.5f));
          widest = std::max({widest, off.x, off.y});
        }
        EXPECT_LT(widest, 0.5f);
        EXPECT_GT(widest, 0.4f);
      }
}

TEST(Camera, FramingNothingOrAPointIsStillACamera) {
  for (const Bounds& box : {Bounds{}, Bounds{vec3(7), vec3(7)}, Bounds{vec3(0), vec3(0)}}) {
    const Camera camera = framingCamera(box, 1);
    const vec3 target = box.empty() ? vec3(0) : box.min;
    EXPECT_TRUE(isFinite(camera.position));
    EXPECT_GT(glm::distance(camera.position, target), 0.1f);
    expectNear(-camera.back, glm::normalize(target - camera.position), 1e-5f);
  }
}

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/framing.h"
#include "test_scene.h"

namespace chromeball::camera_test {
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

TEST(Camera, LensRaysMeetInTheFocalPlane) {
  Camera camera = Camera::lookAt({1, 2, 3}, {-4, 0, 1}, {0, 1, 0}, 0.7f);
  camera.lensRadius = 0.3f;
  camera.focus = 5;
  const CameraRays rays(camera, 1.5f);
  ASSERT_TRUE(rays.hasLens());
  EXPECT_FALSE(CameraRays(Camera(), 1).hasLens());
  for (const vec2 uv : {vec2(0.5f, 0.5f), vec2(0.1f, 0.8f)}) {
    vec3 origin, direction;
    rays.ray(uv.x, uv.y, origin, direction);
    const vec3 inFocus = origin + direction * (5 / -glm::dot(direction, camera.back));
    for (const vec2 lens : {vec2(0.2f, 0.9f), vec2(0.99f, 0.3f), vec2(0.5f, 0.5f)}) {
      rays.ray(uv.x, uv.y, lens, origin, direction);
      EXPECT_NEAR(glm::length(direction), 1, 1e-6);
      EXPECT_LE(glm::distance(origin, camera.position), 0.3f + 1e-6f);
      EXPECT_NEAR(glm::dot(origin - camera.position, camera.back), 0, 1e-6);
      const vec3 to = inFocus - origin;
      EXPECT_NEAR(glm::length(glm::cross(to, direction)), 0, 2e-6);
    }
  }
}

// A point at distance z appears as a disc of diameter D = aperture |z - focus| / z in the focal
// plane, with variance D^2 / 16 along each axis.
TEST(Camera, CircleOfConfusion) {
  constexpr float kAperture = 0.4f, kFocus = 4, kFov = 0.5f;
  constexpr int kSize = 64;
  for (const float z : {2.5f, 4.0f, 8.0f}) {
    Scene scene;
    Material glow = lambert(Rgb(0));
    glow.emission = Rgb(1);
    const float half = 0.04f * z;
    addQuad(scene, addMaterial(scene, glow), {-half, -half, -z}, {2 * half, 0, 0},
            {0, 2 * half, 0});
    Camera camera;
    camera.fov = kFov;
    camera.lensRadius = kAperture / 2;
    camera.focus = kFocus;
    const Probe black(Image(2, 1, 3));
    const Image image =
        renderScene(scene, camera, black, "bsdf", smallRender(kSize, kSize, 256, 0)).film.mean();
    double sum = 0, variance = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double dx = x + 0.5 - kSize / 2.0;
        sum += image.rgb(x, y).x;
        variance += image.rgb(x, y).x * dx * dx;
      }
    const double pixel = 2 * kFocus * std::tan(kFov / 2.0) / kSize;  // metres in the focal plane
    const double blur = kAperture * std::fabs(z - kFocus) / z / pixel;
    const double source = 2 * half * kFocus / z / pixel;  // the variance of a square is side^2 / 12
    const double expected = blur * blur / 16 + source * source / 12 + 1 / 12.0;
    EXPECT_NEAR(variance / sum / expected, 1, 0.03) << z;
    EXPECT_NEAR(sum / (source * source), 1, 0.02) << z;  // defocus conserves energy
  }
}

TEST(Camera, BeamsCoverTheImageFourTimes) {
  Camera camera;
  camera.fov = kPi / 2;
  EXPECT_NEAR(beamOf(camera, 100, 16).crossSection(3) * 16 * 100 * 100, 4 * 36, 1e-4);
  camera.orthographic = true;
  camera.halfHeight = 5;
  EXPECT_NEAR(beamOf(camera, 100, 8).crossSection(3) * 8 * 100 * 100, 4 * 100, 1e-4);
  EXPECT_FALSE(Beam{});
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

TEST(Camera, LookAtRejectsDegenerateFrames) {
  EXPECT_THROW(Camera::lookAt({1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 1), InputError);
  EXPECT_THROW(Camera::lookAt({0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1), InputError);
  EXPECT_THROW(Camera::lookAt({0, 5, 0}, {1, 0, 0}, {0, 0, 0}, 1), InputError);
}

// The image point of a position; (0.5, 0.5) is the centre.
vec2 project(const Camera& camera, vec3 p, float aspect) {
  const vec3 q = p - camera.position;
  const float depth = -glm::dot(q, camera.back);
  EXPECT_GT(depth, 0);
  const float tanHalf = std::tan(camera.fov / 2);
  return {0.5f + 0.5f * glm::dot(q, camera.right) / (depth * tanHalf * aspect),
          0.5f - 0.5f * glm::dot(q, camera.up) / (depth * tanHalf)};
}

TEST(Camera, FramingShowsAllVerticesAndFillsTheImage) {
  for (const float aspect : {0.4f, 1.0f, 2.5f})
    for (const float size : {1e-3f, 1.0f, 1e4f})
      for (const vec3 shape : {vec3(1, 1, 1), vec3(10, 1, 1), vec3(1, 10, 0), vec3(0, 1, 10)}) {
        Scene scene;
        addSphere(scene, addMaterial(scene, {}), vec3(0), 1);
        for (vec3& p : scene.meshes.edit(0).positions) p = size * (vec3(3, -2, 1) + shape * p);
        const Camera camera = framingCamera(scene, aspect);
        if (shape.x * shape.z > 0) {  // from the front, above, from the right
          EXPECT_GT(camera.back.z, 0.8f);
          EXPECT_GT(camera.back.y, 0);
          EXPECT_GT(camera.back.x, 0);
        } else {  // discs, from their fronts
          EXPECT_NEAR(camera.back[shape.x > 0 ? 2 : 0], 1, 1e-6f);
        }
        vec2 minimum(1), maximum(0);
        for (const vec3& p : scene.meshes[0].positions) {
          minimum = glm::min(minimum, project(camera, p, aspect));
          maximum = glm::max(maximum, project(camera, p, aspect));
        }
        EXPECT_TRUE(glm::all(glm::greaterThan(minimum, vec2(0.02f))))
            << minimum.x << " " << minimum.y;
        EXPECT_TRUE(glm::all(glm::lessThan(maximum, vec2(0.98f)))) << maximum.x << " " << maximum.y;
        EXPECT_NEAR(maxComponent(vec3(maximum - minimum, 0)), 1 / 1.05f, 1e-3f);
      }
}

TEST(Camera, FramingOfAnEmptySceneOrAPointIsValid) {
  for (const vec3& point : {vec3(0), vec3(7)}) {
    Scene scene;
    if (point.x > 0) {
      addMesh(scene, addMaterial(scene, {}), {});
      scene.meshes.edit(0).positions.assign(3, point);
    }
    const Camera camera = framingCamera(scene, 1);
    EXPECT_TRUE(isFinite(camera.position));
    EXPECT_GT(glm::distance(camera.position, point), 0.1f);
    expectNear(-camera.back, glm::normalize(point - camera.position), 1e-5f);
  }
}

}  // namespace
}  // namespace chromeball::camera_test

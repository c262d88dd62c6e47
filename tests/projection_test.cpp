// SPDX-License-Identifier: Apache-2.0
// Projection of an image from a camera: lookups return the pixel that sees a point, if any.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace chromeball::projection_test {
namespace {

Camera obliqueCamera(bool orthographic) {
  Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.4f, 0}, {0.1f, 1, 0}, 0.7f);
  camera.orthographic = orthographic;
  camera.halfHeight = 1.3f;
  return camera;
}

Image depths(int width, int height, float depth) {
  Image image(width, height, 1);
  for (float& texel : image.texels) texel = depth;
  return image;
}

TEST(Projection, InvertsTheCamerasRays) {
  constexpr int kWidth = 24, kHeight = 16;
  for (bool orthographic : {false, true}) {
    const Camera camera = obliqueCamera(orthographic);
    const CameraRays rays(camera, float(kWidth) / kHeight);
    Projection projection(camera, kWidth, kHeight);
    projection.setDepth(depths(kWidth, kHeight, 10));
    for (size_t i = 0; i < projection.colors().texels.size(); ++i)
      projection.colors().texels[i] = float(i);
    for (int i = 0; i < 4000; ++i) {
      const float u = toUnit(uint32_t(hash(3 * i))), v = toUnit(uint32_t(hash(3 * i + 1)));
      vec3 origin, direction;
      rays.ray(u, v, origin, direction);
      const vec3 point =
          origin + 9 * toUnit(uint32_t(hash(3 * i + 2))) * direction + 0.1f * direction;
      const float x = u * kWidth, y = v * kHeight;
      const float margin = 1e-3f;  // pixels; closer to an edge, rounding may select the next pixel
      if (std::min({x - std::floor(x), y - std::floor(y)}) < margin ||
          std::max({x - std::floor(x), y - std::floor(y)}) > 1 - margin)
        continue;
      const auto seen = projection.lookup(point);
      ASSERT_TRUE(seen) << u << " " << v;
      EXPECT_EQ(*seen, projection.colors().rgb(int(x), int(y)));
    }
  }
}

TEST(Projection, HasNoValueForPointsThatTheCameraDoesNotSee) {
  Camera camera;  // at the origin, looks along -Z
  camera.fov = glm::radians(90.0f);
  Projection projection(camera, 9, 9);
  Image depth = depths(9, 9, 0);
  *depth.at(4, 4) = 2;
  projection.setDepth(depth);
  EXPECT_TRUE(projection.lookup({0, 0, -1.9f}));
  EXPECT_FALSE(projection.lookup({0, 0, -2.1f}));     // occluded
  EXPECT_FALSE(projection.lookup({0, 0, 1.9f}));      // behind the camera
  EXPECT_FALSE(projection.lookup({0.9f, 0, -1.9f}));  // a pixel without a hit
  EXPECT_FALSE(projection.lookup({3, 0, -1.9f}));     // outside of the image
  *depth.at(5, 4) = 3;  // a lookup uses the maximum depth of the neighbours
  projection.setDepth(depth);
  EXPECT_TRUE(projection.lookup({0, 0, -2.9f}));
  EXPECT_FALSE(projection.lookup({0, 0, -3.1f}));
}

}  // namespace
}  // namespace chromeball::projection_test

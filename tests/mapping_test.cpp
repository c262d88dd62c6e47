// SPDX-License-Identifier: Apache-2.0
// Omnidirectional mappings: direction to image position and back, solid angles, detection.
#include "probe/mapping.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/synth.h"

namespace chromeball::mapping_test {
namespace {

constexpr std::array kMappings = {Mapping::LatLong,         Mapping::AngularMap,
                                  Mapping::MirrorBall,      Mapping::VerticalCross,
                                  Mapping::HorizontalCross, Mapping::HorizontalStrip,
                                  Mapping::VerticalStrip,   Mapping::CubeGrid};

// Directions over the whole sphere and special cases: axes, edges and corners of the cube, both
// sides of the seam, close to the poles and to the view axis.
std::vector<dvec3> directions() {
  std::vector<dvec3> all;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (x != 0 || y != 0 || z != 0) all.push_back(glm::normalize(dvec3(x, y, z)));
  for (const double tiny : {1e-3, 1e-6, 1e-9})
    for (const double side : {-1.0, 1.0}) {
      all.push_back(glm::normalize(dvec3(side * tiny, 0.3, 1)));
      all.push_back(glm::normalize(dvec3(side * tiny, 0, -1)));
      all.push_back(glm::normalize(dvec3(side * tiny, 1, tiny)));
      all.push_back(glm::normalize(dvec3(1, 1 + side * tiny, 0.2)));
    }
  for (int i = 0; i < 2000; ++i) {
    const double y = 1 - 2 * (i + 0.5) / 2000, phi = 2.399963229728653 * i,
                 r = std::sqrt(1 - y * y);
    all.push_back({r * std::cos(phi), y, r * std::sin(phi)});
  }
  return all;
}

TEST(Mapping, DirectionToImageAndBack) {
  for (const Mapping mapping : kMappings)
    for (const dvec3& d : directions()) {
      const dvec2 uv = directionToUv(mapping, d);
      const auto back = uvToDirection(mapping, glm::clamp(uv, dvec2(0), dvec2(1)));
      // Rounding may move a position on the rim out of the disc.
      if (!back && glm::distance(uv, dvec2(0.5)) < 0.5 + 1e-12) continue;
      ASSERT_TRUE(back) << mappingName(mapping);
      // At the mirror ball's rim, an error of 1e-16 in radius is one of 1e-8 in direction.
      EXPECT_LT(glm::distance(*back, d), mapping == Mapping::MirrorBall ? 1e-7 : 1e-12)
          << mappingName(mapping) << " " << d.x << " " << d.y << " " << d.z;
      // The length does not matter.
      EXPECT_LT(glm::distance(directionToUv(mapping, 7.0 * d), uv), 1e-12);
    }
}

TEST(Mapping, ImageToDirectionAndBack) {
  constexpr int kSteps = 60;
  for (const Mapping mapping : kMappings) {
    int valid = 0;
    for (int j = 0; j < kSteps; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const dvec2 uv((i + 0.5) / kSteps, (j + 0.5) / kSteps);
        const auto direction = uvToDirection(mapping, uv);
        if (!direction) continue;
        ++valid;
        EXPECT_NEAR(glm::length(*direction), 1, 1e-14);
        EXPECT_LT(glm::distance(directionToUv(mapping, *direction), uv), 1e-10)
            << mappingName(mapping) << " " << uv.x << " " << uv.y;
      }
    const double fraction = mapping == Mapping::AngularMap || mapping == Mapping::MirrorBall
                                ? kPiD / 4
                            : faceLayout(mapping).columns * faceLayout(mapping).rows == 12 ? 0.5
                                                                                           : 1;
    EXPECT_NEAR(double(valid) / (kSteps * kSteps), fraction, 0.01) << mappingName(mapping);
  }
}

TEST(Mapping, CentresAreForwardAndTopsAreUp) {
  const auto expectUv = [](Mapping mapping, const dvec3& d, double u, double v) {
    const dvec2 uv = directionToUv(mapping, d);
    EXPECT_NEAR(uv.x, u, 1e-12) << mappingName(mapping);
    EXPECT_NEAR(uv.y, v, 1e-12) << mappingName(mapping);
  };
  expectUv(Mapping::LatLong, {0, 0, -1}, 0.5, 0.5);
  expectUv(Mapping::LatLong, {1, 0, 0}, 0.75, 0.5);
  EXPECT_EQ(directionToUv(Mapping::LatLong, {0, 1, 0}).y, 0);  // any u
  expectUv(Mapping::AngularMap, {0, 0, -1}, 0.5, 0.5);
  expectUv(Mapping::AngularMap, {1, 0, 0}, 0.75, 0.5);  // 90 degrees: half way to the rim
  expectUv(Mapping::AngularMap, {0, 1, 0}, 0.5, 0.25);
  expectUv(Mapping::MirrorBall, {1, 0, 0}, 0.5 + 0.5 * std::sqrt(0.5), 0.5);
  expectUv(Mapping::MirrorBall, {0, 1, 0}, 0.5, 0.5 - 0.5 * std::sqrt(0.5));
  expectUv(Mapping::VerticalCross, {0, 0, -1}, 0.5, 3.0 / 8);
  expectUv(Mapping::VerticalCross, {0, 0, 1}, 0.5, 7.0 / 8);
  expectUv(Mapping::VerticalCross, {1, 0, 0}, 5.0 / 6, 3.0 / 8);
  expectUv(Mapping::HorizontalCross, {0, 0, 1}, 7.0 / 8, 0.5);
  expectUv(Mapping::VerticalStrip, {0, 0, -1}, 0.5, 11.0 / 12);
  // +X -X +Y / -Y +Z -Z
  expectUv(Mapping::CubeGrid, {1, 0, 0}, 1.0 / 6, 1.0 / 4);
  expectUv(Mapping::CubeGrid, {-1, 0, 0}, 3.0 / 6, 1.0 / 4);
  expectUv(Mapping::CubeGrid, {0, 1, 0}, 5.0 / 6, 1.0 / 4);
  expectUv(Mapping::CubeGrid, {0, -1, 0}, 1.0 / 6, 3.0 / 4);
  expectUv(Mapping::CubeGrid, {0, 0, 1}, 3.0 / 6, 3.0 / 4);
  expectUv(Mapping::CubeGrid, {0, 0, -1}, 5.0 / 6, 3.0 / 4);
  expectUv(Mapping::CubeGrid, {0, 0.5, -1}, 5.0 / 6, 5.0 / 8);  // up is up, +X is right of -Z
  expectUv(Mapping::CubeGrid, {0.5, 0, -1}, 11.0 / 12, 3.0 / 4);
  // The whole rim is the direction opposite to the view axis.
  EXPECT_NEAR(glm::distance(directionToUv(Mapping::AngularMap, {0, 0, 1}), dvec2(0.5)), 0.5, 1e-12);
  EXPECT_FALSE(uvToDirection(Mapping::AngularMap, {0.02, 0.02}));
  EXPECT_FALSE(uvToDirection(Mapping::VerticalCross, {0.1, 0.1}));
  EXPECT_FALSE(uvToDirection(Mapping::LatLong, {1.1, 0.5}));
}

// Across each edge between faces of the vertical cross the mapping is continuous: a small step in
// the image is a small step in direction.
TEST(Mapping, CrossIsContinuousAtInnerEdges) {
  const double tiny = 1e-7;
  const std::array<dvec2, 5> edges{
      {{1 / 3., 3 / 8.}, {2 / 3., 3 / 8.}, {0.5, 0.25}, {0.5, 0.5}, {0.5, 0.75}}};
  for (const dvec2& edge : edges) {
    const dvec2 step = edge.x == 0.5 ? dvec2(0, tiny) : dvec2(tiny, 0);
    const auto before = uvToDirection(Mapping::VerticalCross, edge - step);
    const auto after = uvToDirection(Mapping::VerticalCross, edge + step);
    ASSERT_TRUE(before && after);
    EXPECT_LT(glm::distance(*before, *after), 20 * tiny);
  }
}

TEST(Mapping, SolidAnglesSumToTheSphere) {
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {3, 2}, {64, 32}, {4096, 2048}}) {
    double sum = 0;
    for (int y = 0; y < h; ++y) sum += w * texelSolidAngle(y, w, h);
    EXPECT_NEAR(sum, 4 * kPiD, 1e-11) << w << " x " << h;
  }
  // 1 - cos(pi/H) by its series; the plain difference loses half the digits.
  EXPECT_NEAR(texelSolidAngle(0, 1, 1 << 20) / (kPiD * std::pow(kPiD / (1 << 20), 2)), 1, 1e-11);

  constexpr int kSteps = 600;
  for (const Mapping mapping : kMappings) {
    double sum = 0;
    for (int j = 0; j < kSteps; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const dvec2 uv((i + 0.5) / kSteps, (j + 0.5) / kSteps);
        if (uvToDirection(mapping, uv)) sum += solidAngleJacobian(mapping, uv);
      }
    EXPECT_NEAR(sum / (kSteps * kSteps), 4 * kPiD, 0.01) << mappingName(mapping);
  }
}

// The solid angle of a small square of the map around uv, over its area, from directions alone.
double measuredJacobian(Mapping mapping, const dvec2& uv) {
  constexpr double kStep = 1e-5;
  const auto derivative = [&](const dvec2& step) {
    return (*uvToDirection(mapping, uv + step) - *uvToDirection(mapping, uv - step)) / (2 * kStep);
  };
  return glm::length(glm::cross(derivative({kStep, 0}), derivative({0, kStep})));
}

// The ideal mirror ball has equal areas: 4 pi over the disc's pi / 4.
TEST(Mapping, TheMirrorBallIsOfEqualArea) {
  for (int i = 1; i < 20; ++i)
    for (const double angle : {0.1, 1.3, 2.2, 4.0, 5.9}) {
      const double radius = 0.5 * i / 20;
      const dvec2 uv = 0.5 + radius * dvec2(std::cos(angle), std::sin(angle));
      EXPECT_NEAR(measuredJacobian(Mapping::MirrorBall, uv) / 16, 1, 1e-6) << radius;
    }
  // Also close to the rim, where a step in the image is a large one in direction: the solid angle
  // of a ring is 2 pi times the difference of -z.
  double before = -1;
  for (int i = 1; i <= 1000; ++i) {
    const double radius = 0.5 * i / 1000;
    const double z = uvToDirection(Mapping::MirrorBall, {0.5 + radius, 0.5})->z;
    const double area = kPiD * (radius * radius - 0.25 * std::pow((i - 1) / 1000., 2));
    EXPECT_NEAR(2 * kPiD * (z - before) / area / 16, 1, 1e-6) << radius;
    before = z;
  }
}

// HDRI book, section 9.4: the map's radius is proportional to the angle from its centre, and
// lengths along circles about the centre are stretched by angle / sin(angle).
TEST(Mapping, TheAngularMapIsEvenAlongItsRadius) {
  for (int i = 1; i < 20; ++i) {
    const double theta = kPiD * i / 20, radius = 0.5 * i / 20, step = 1e-6;
    const auto at = [&](double x, double y) {
      return *uvToDirection(Mapping::AngularMap, {0.5 + x, 0.5 + y});
    };
    const double radial = glm::distance(at(radius + step, 0), at(radius - step, 0)) / (2 * step);
    const double tangential = glm::distance(at(radius, step), at(radius, -step)) / (2 * step);
    EXPECT_NEAR(radial / (2 * kPiD), 1, 1e-6);
    EXPECT_NEAR(radial / tangential, theta / std::sin(theta), 1e-5 * theta / std::sin(theta));
    EXPECT_NEAR(measuredJacobian(Mapping::AngularMap, {0.5 + radius, 0.5}) /
                    solidAngleJacobian(Mapping::AngularMap, {0.5 + radius, 0.5}),
                1, 1e-6);
  }
}

// Texels in the centre of a face cover 3 sqrt(3) times the solid angle of those in its corners.
TEST(Mapping, CubeTexelsDifferByAFactorOfFive) {
  for (const Mapping mapping : kMappings) {
    const auto [columns, rows] = faceLayout(mapping);
    if (columns * rows == 1) continue;
    const TexelSolidAngles angles = texelSolidAngles(mapping, {512 * columns, 512 * rows});
    EXPECT_NEAR(angles.max / angles.min, 3 * std::sqrt(3.), 0.021) << mappingName(mapping);
    EXPECT_EQ(angles.texels, 6u * 512 * 512);
    // A texel on the axis has the area of its square at distance 1, but for its slant.
    EXPECT_NEAR(angles.max * 256 * 256, 1, 1e-4);
    const TexelSolidAngles single = texelSolidAngles(mapping, {columns, rows});
    EXPECT_NEAR(single.max, 4 * kPiD / 6, 1e-12);
    EXPECT_EQ(single.min, single.max);
  }
}

TEST(Mapping, SolidAnglesOfTexels) {
  const TexelSolidAngles ball = texelSolidAngles(Mapping::MirrorBall, {100, 100});
  EXPECT_EQ(ball.min, ball.max);
  EXPECT_NEAR(ball.min, 16 / 1e4, 1e-15);
  EXPECT_NEAR(double(ball.texels) / 1e4, kPiD / 4, 0.005);
  const TexelSolidAngles latLong = texelSolidAngles(Mapping::LatLong, {64, 32});
  EXPECT_NEAR(latLong.min, texelSolidAngle(0, 64, 32), 1e-17);
  EXPECT_EQ(latLong.max, texelSolidAngle(15, 64, 32));
  const TexelSolidAngles angular = texelSolidAngles(Mapping::AngularMap, {101, 101});
  EXPECT_NEAR(angular.max * 101 * 101 / (4 * kPiD * kPiD), 1, 1e-12);
  EXPECT_LT(angular.min, 0.02 * angular.max);
}

TEST(Mapping, NamesAndShapes) {
  EXPECT_EQ(parseMapping("cube-cross", 30, 40, "x"), Mapping::VerticalCross);
  EXPECT_EQ(parseMapping("cube-cross", 40, 30, "x"), Mapping::HorizontalCross);
  EXPECT_EQ(parseMapping("cube-strip", 60, 10, "x"), Mapping::HorizontalStrip);
  EXPECT_EQ(parseMapping("cube-3x2", 30, 20, "x"), Mapping::CubeGrid);
  EXPECT_EQ(parseMapping("lat-long", 7, 5, "x"), Mapping::LatLong);
  EXPECT_EQ(parseMapping("auto", 7, 5, "x"), std::nullopt);
  EXPECT_THROW(parseMapping("angular", 7, 5, "x"), InputError);
  EXPECT_THROW(parseMapping("cube-cross", 31, 41, "x"), InputError);
  EXPECT_THROW(parseMapping("latlong", 7, 5, "x"), InputError);
}

TEST(Mapping, IsDetected) {
  const auto detect = [](int w, int h, float corner) {
    Image image(w, h, 3);
    std::fill(image.texels.begin(), image.texels.end(), 1.0f);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        if (!uvToDirection(Mapping::AngularMap, {(x + 0.5) / w, (y + 0.5) / h}))
          image.setRgb(x, y, Rgb(corner));
    return detectMapping(image);
  };
  EXPECT_EQ(detect(64, 32, 1).mapping, Mapping::LatLong);
  EXPECT_EQ(detect(64, 64, 0).mapping, Mapping::AngularMap);
  EXPECT_EQ(detect(64, 64, 1).mapping, Mapping::MirrorBall);
  EXPECT_EQ(detect(48, 64, 1).mapping, Mapping::VerticalCross);
  EXPECT_EQ(detect(64, 48, 1).mapping, Mapping::HorizontalCross);
  EXPECT_EQ(detect(96, 16, 1).mapping, Mapping::HorizontalStrip);
  EXPECT_EQ(detect(16, 96, 1).mapping, Mapping::VerticalStrip);
  EXPECT_EQ(detect(48, 32, 1).mapping, Mapping::CubeGrid);
  EXPECT_FALSE(detect(48, 32, 1).certain);  // photographs have this shape
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 2}, {2, 3}, {100, 70}})
    EXPECT_EQ(detect(w, h, 1).mapping, Mapping::LatLong) << w << " x " << h;
  EXPECT_FALSE(detect(100, 70, 1).certain);
}

// The rim lights texels whose centres are outside the disc: in small maps, more than one in ten of
// all outside.
TEST(Mapping, AnAngularMapIsDetectedAtAnySize) {
  const Image sky = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.3, 0.5, -0.2});
  for (const int size : {16, 17, 24, 32, 50, 64, 99, 100, 128, 257}) {
    Image map = convert(sky, Mapping::LatLong, Mapping::AngularMap, {size, size});
    EXPECT_EQ(detectMapping(map).mapping, Mapping::AngularMap) << size;
    for (int y = 0; y < size / 8; ++y)  // two corners of a photograph of a ball
      for (int x = 0; x < size / 8; ++x)
        for (const int left : {x, size - 1 - x}) map.setRgb(left, y, Rgb(0.5f));
    EXPECT_EQ(detectMapping(map).mapping, Mapping::MirrorBall) << size;
  }
}

}  // namespace
}  // namespace chromeball::mapping_test

// SPDX-License-Identifier: Apache-2.0
#include "math/polygon.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/warp.h"
#include "probe/mapping.h"
#include "sphere_test.h"

namespace chromeball::spherical_polygon_test {
namespace {

dvec3 at(double azimuth, double elevation) { return directionAt(azimuth, elevation); }

SphericalPolygon polygon(const std::vector<dvec3>& corners) { return {corners, "test"}; }

// Not convex: an L.
std::vector<dvec3> ell() {
  return {at(0, 20), at(-50, 20), at(-50, 40), at(-25, 40), at(-25, 70), at(0, 70)};
}

// Girard: the sum of the angles - pi. An octant has pi / 2.
TEST(SphericalPolygon, SolidAngleOfAnOctant) {
  const SphericalPolygon octant = polygon({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_NEAR(octant.solidAngle(), kPiD / 2, 1e-14);
  EXPECT_NEAR(octant.vectorIrradiance().x, kPiD / 4, 1e-14);  // a quarter of pi on each face
  EXPECT_TRUE(octant.contains(glm::normalize(dvec3(1, 1, 1))));
  EXPECT_FALSE(octant.contains(glm::normalize(dvec3(-0.1, 1, 1))));
  EXPECT_FALSE(octant.contains(glm::normalize(dvec3(-1, -1, -1))));
}

TEST(SphericalPolygon, TheOrderOfCornersDoesNotMatter) {
  std::vector<dvec3> corners = ell();
  const SphericalPolygon one = polygon(corners);
  std::ranges::reverse(corners);
  const SphericalPolygon other = polygon(corners);
  EXPECT_NEAR(one.solidAngle(), other.solidAngle(), 1e-14);
  EXPECT_LT(glm::distance(one.vectorIrradiance(), other.vectorIrradiance()), 1e-14);
}

// Uniform directions over the sphere that the polygon contains: solid angle and irradiance.
TEST(SphericalPolygon, AgreesWithIntegration) {
  for (const auto& corners : {ell(), std::vector<dvec3>{at(10, 80), at(130, 75), at(250, 85)}}) {
    const SphericalPolygon p = polygon(corners);
    const dvec3 normal = glm::normalize(dvec3(0.1, 1, -0.2));
    constexpr int kSide = 2000;
    double solidAngle = 0, irradiance = 0;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const double y = (i + 0.5) / kSide, phi = 2 * kPiD * (j + 0.5) / kSide;  // upper half
        const double r = std::sqrt(1 - y * y);
        const dvec3 d(r * std::cos(phi), y, r * std::sin(phi));
        if (!p.contains(d)) continue;
        solidAngle += 2 * kPiD / (double(kSide) * kSide);
        irradiance += 2 * kPiD / (double(kSide) * kSide) * glm::dot(d, normal);
      }
    EXPECT_NEAR(p.solidAngle() / solidAngle, 1, 5e-3);
    EXPECT_NEAR(glm::dot(p.vectorIrradiance(), normal) / irradiance, 1, 5e-3);
  }
}

// The mean cosine of samples, at the midpoints of a grid of random numbers, gives Lambert's
// formula. An L is several triangles, at whose limits the grid is less accurate.
TEST(SphericalPolygon, SamplesGiveLambertsFormula) {
  const dvec3 normal = glm::normalize(dvec3(-0.2, 1, -0.4));
  const auto check = [&](const SphericalPolygon& p, double tolerance) {
    constexpr int kSide = 1000;
    double sum = 0;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j)
        sum += glm::dot(normal, p.sample((i + 0.5) / kSide, (j + 0.5) / kSide));
    const double irradiance = sum / (double(kSide) * kSide) * p.solidAngle();
    EXPECT_NEAR(irradiance / glm::dot(normal, p.vectorIrradiance()), 1, tolerance);
  };
  check(polygon({at(0, 20), at(-50, 25), at(-20, 70)}), 1e-5);
  check(polygon(ell()), 1e-4);
}

TEST(SphericalPolygon, SamplesAreUniform) {
  const SphericalPolygon p = polygon(ell());
  const auto draw = [&](int i) -> std::optional<vec3> {
    const vec2 u = random2(i, 0);
    return vec3(p.sample(u.x, u.y));
  };
  const SphereTest test = testDirections(
      draw,
      [&](const vec3& wi) { return p.contains(dvec3(wi)) ? float(1 / p.solidAngle()) : 0.0f; },
      60000);
  EXPECT_NEAR(test.totalProbability, 1, 5e-3);
  EXPECT_GT(test.chiSquare.pValue, 1e-3);
}

TEST(SphericalPolygon, TinyOnesKeepTheirShape) {
  for (const double size : {1e-2, 1e-5, 1e-8}) {
    const dvec3 centre = at(30, 40), x = glm::normalize(glm::cross(centre, dvec3(0, 1, 0))),
                y = glm::cross(centre, x);
    std::vector<dvec3> corners;
    for (const dvec2& c : {dvec2(0, 0), dvec2(2, 0), dvec2(2, 1), dvec2(0, 1)})
      corners.push_back(glm::normalize(centre + size * (c.x * x + c.y * y)));
    const SphericalPolygon p = polygon(corners);
    EXPECT_NEAR(p.solidAngle() / (2 * size * size), 1, 1e-3) << size;
    for (int i = 0; i < 1000; ++i) {
      const vec2 u = random2(i, 0);
      const dvec3 offset = (p.sample(u.x, u.y) - centre) / size;
      EXPECT_GT(glm::dot(offset, x), -1e-3);
      EXPECT_LT(glm::dot(offset, x), 2 + 1e-3);
      EXPECT_GT(glm::dot(offset, y), -1e-3);
      EXPECT_LT(glm::dot(offset, y), 1 + 1e-3);
    }
  }
}

TEST(SphericalPolygon, RefusesOthers) {
  EXPECT_THROW(polygon({at(0, 0), at(10, 0)}), InputError);
  EXPECT_THROW(polygon({at(0, 0), at(10, 0), at(10, 0)}), InputError);
  EXPECT_THROW(polygon({at(0, 0), at(10, 0), at(20, 0)}), InputError);              // no area
  EXPECT_THROW(polygon({at(0, 0), at(10, 10), at(10, 0), at(0, 10)}), InputError);  // crossing
  EXPECT_THROW(polygon({at(0, 0), at(120, 0), at(240, 0)}), InputError);            // all around
  EXPECT_THROW(polygon(std::vector<dvec3>(65, at(0, 0))), InputError);
}

TEST(PlanarPolygon, HullAndTriangles) {
  const std::vector<dvec2> hull =
      convexHull({{0, 0}, {1, 1}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {1, 1.5}, {0, 0}});
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_NEAR(signedArea(hull), 4, 1e-15);
  const std::vector<dvec2> comb{{0, 0}, {5, 0}, {5, 3}, {4, 1}, {3, 3}, {2, 1}, {1, 3}, {0, 1}};
  ASSERT_FALSE(whyNotSimple(comb));
  double area = 0;
  for (const auto& [i, j, k] : triangulate(comb)) {
    const double part = signedArea(std::vector<dvec2>{comb[i], comb[j], comb[k]});
    EXPECT_GT(part, 0);
    area += part;
  }
  EXPECT_NEAR(area, signedArea(comb), 1e-12);
}

}  // namespace
}  // namespace chromeball::spherical_polygon_test

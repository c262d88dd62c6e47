// SPDX-License-Identifier: Apache-2.0
// Fisheye lenses as mappings.
#include "probe/fisheye.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/convert.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::fisheye_test {
namespace {

using enum FisheyeProjection;

const std::vector<Fisheye> kLenses{{180, Equidistant},  {220, Equidistant},   {360, Equidistant},
                                   {180, Equisolid},    {235, Equisolid},     {120, Orthographic},
                                   {180, Orthographic}, {180, Stereographic}, {300, Stereographic}};

// Directions at even steps of the angle from the axis, inside the field of view.
template <class Body>
void forDirections(const Fisheye& lens, const Body& body) {
  for (int i = 0; i <= 100; ++i)
    for (int j = 0; j < 16; ++j) {
      const double angle = lens.halfAngle() * i / 100, around = 2 * kPiD * (j + 0.3) / 16;
      body(angle, dvec3(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                        -std::cos(angle)));
    }
}

TEST(Fisheye, DirectionToImageAndBack) {
  for (const Fisheye& lens : kLenses)
    forDirections(lens, [&](double angle, const dvec3& d) {
      const dvec2 uv = directionToUv(lens, d);
      const std::optional<dvec3> back = uvToDirection(lens, uv);
      // On the rim, rounding may move it out. There the sine has its maximum if the projection is
      // orthographic and shows 180 degrees: the image hardly moves, and 1e-16 in it corresponds to
      // 1e-8 radians.
      if (!back) {
        EXPECT_NEAR(angle, lens.halfAngle(), 1e-9);
        return;
      }
      const bool isFlat = lens == Fisheye{180, Orthographic} && angle > 0.999 * lens.halfAngle();
      EXPECT_LT(glm::distance(*back, d), isFlat ? 1e-7 : 1e-12)
          << fisheyeName(lens) << " " << angle;
      EXPECT_LT(glm::distance(directionToUv(lens, *back), uv), 1e-12) << fisheyeName(lens);
      EXPECT_NEAR(glm::length(*back), 1, 1e-14);
    });
}

TEST(Fisheye, FollowsItsFormula) {
  const double t = 0.7, h = kPiD / 3;
  EXPECT_NEAR((Fisheye{120, Equidistant}.radius(t)), t / h, 1e-15);
  EXPECT_NEAR((Fisheye{120, Equisolid}.radius(t)), std::sin(t / 2) / std::sin(h / 2), 1e-15);
  EXPECT_NEAR((Fisheye{120, Orthographic}.radius(t)), std::sin(t) / std::sin(h), 1e-15);
  EXPECT_NEAR((Fisheye{120, Stereographic}.radius(t)), std::tan(t / 2) / std::tan(h / 2), 1e-15);
  for (const Fisheye& lens : kLenses) {
    EXPECT_NEAR(lens.radius(lens.halfAngle()), 1, 1e-15) << fisheyeName(lens);
    // Directions outside the field of view are outside the disc, also where the sine falls again.
    for (double angle = lens.halfAngle() + 0.01; angle < kPiD; angle += 0.05)
      EXPECT_GT(lens.radius(angle), 1) << fisheyeName(lens);
  }
}

TEST(Fisheye, SolidAngles) {
  for (const Fisheye& lens : kLenses) {
    double sum = 0, before = 0;
    constexpr int kRings = 4000;
    for (int i = 1; i <= kRings; ++i) {
      const double r = (i - 0.5) / kRings, angle = lens.angle(double(i) / kRings);
      // The exact solid angle of a ring, where the derivative is finite.
      const double ring = 2 * kPiD * (std::cos(before) - std::cos(angle));
      const double area = 2 * kPiD * r / kRings;
      if (i < 0.99 * kRings) {
        EXPECT_NEAR(lens.solidAngleJacobian(r) * area / ring, 1, 1e-4) << fisheyeName(lens) << r;
      }
      sum += ring;
      before = angle;
    }
    EXPECT_NEAR(sum, lens.solidAngle(), 1e-6) << fisheyeName(lens);
  }
  EXPECT_NEAR((Fisheye{180, Equidistant}.solidAngle()), 2 * kPiD, 1e-14);
}

// The angular map and the ideal mirror ball are fisheye discs of the whole sphere.
TEST(Fisheye, OfTheWholeSphereIsAngularMapOrMirrorBall) {
  const Image probe = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.5, -0.3, 0.6});
  for (const auto& [lens, kind] : {std::pair{Fisheye{360, Equidistant}, Mapping::AngularMap},
                                   std::pair{Fisheye{360, Equisolid}, Mapping::MirrorBall}}) {
    const Mapping fisheye(lens), disc(kind);
    EXPECT_NE(fisheye, disc);
    for (const dvec3& d : {dvec3(0, 0, -1), dvec3(0.3, -0.2, 0.7), dvec3(0, 0, 1), dvec3(-1, 2, 0)})
      EXPECT_EQ(directionToUv(fisheye, d), directionToUv(disc, d));
    for (int i = 0; i < 400; ++i) {
      const dvec2 uv((i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20);
      EXPECT_EQ(uvToDirection(fisheye, uv), uvToDirection(disc, uv));
      EXPECT_EQ(solidAngleJacobian(fisheye, uv), solidAngleJacobian(disc, uv));
    }
    const ImageSize size = sizeFor(disc, {64, 32});
    EXPECT_EQ(sizeFor(fisheye, {64, 32}).width, size.width);
    const Image there = convert(probe, Mapping::LatLong, disc, size);
    EXPECT_EQ(convert(probe, Mapping::LatLong, fisheye, size).texels, there.texels);
    EXPECT_EQ(convert(there, fisheye, Mapping::LatLong, {64, 32}).texels,
              convert(there, disc, Mapping::LatLong, {64, 32}).texels);
  }
}

// Converts there and back: the radiance inside the field of view is kept, to half a texel's change
// of the gradient, and the rest is black.
TEST(Fisheye, ConvertsToAndFromALatLongMap) {
  const Image probe = gradientProbe({128, 64}, Rgb(1, 2, 3), {0.5, -0.3, 0.6});
  for (const Fisheye& lens : kLenses) {
    const ImageSize size = sizeFor(lens, {128, 64});
    const Image there = convert(probe, Mapping::LatLong, lens, size);
    const Image back = convert(there, lens, Mapping::LatLong, {128, 64});
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 128; ++x) {
        const dvec3 d = texelDirection({128, 64}, x, y);
        const double angle = std::acos(-d.z), texel = 0.06;
        // Towards its rim, an orthographic disc has cos(angle) times as many texels.
        const double coarser =
            lens.projection == FisheyeProjection::Orthographic ? 1 / std::cos(angle) : 1;
        if (angle < lens.halfAngle() - texel) {
          ASSERT_NEAR(back.rgb(x, y).y, probe.rgb(x, y).y, coarser * 2 * 0.84 * 0.5 * kPiD / 64)
              << fisheyeName(lens);
        } else if (angle > lens.halfAngle() + texel) {
          ASSERT_EQ(back.rgb(x, y), Rgb(0)) << fisheyeName(lens);
        }
      }
  }
}

TEST(Fisheye, Names) {
  EXPECT_EQ(parseFisheye("fisheye", "x"), (Fisheye{180, Equidistant}));
  EXPECT_EQ(parseFisheye("fisheye:200", "x"), (Fisheye{200, Equidistant}));
  EXPECT_EQ(parseFisheye("fisheye:185.5:equisolid", "x"), (Fisheye{185.5, Equisolid}));
  for (const Fisheye& lens : kLenses) EXPECT_EQ(parseFisheye(fisheyeName(lens), "x"), lens);
  for (const char* wrong :
       {"fisheye:", "fisheye:x", "fisheye:0", "fisheye:59", "fisheye:361", "fisheye:nan",
        "fisheye:inf", "fisheye:180:", "fisheye:180:equi", "fisheye:181:orthographic",
        "fisheye:301:stereographic", "fisheye:180:equisolid:1", "fisheye:-180"})
    EXPECT_THROW(parseFisheye(wrong, "x"), InputError) << wrong;
  EXPECT_FALSE(namesFisheye("fisheyes"));
  EXPECT_EQ(parseMapping("fisheye:200", 10, 10, "x"), Mapping(Fisheye{200, Equidistant}));
  EXPECT_THROW(parseMapping("fisheye:200", 10, 11, "x"), InputError);
  EXPECT_THROW(parseMapping("fisheyes", 10, 10, "x"), InputError);
  EXPECT_EQ(mappingName(Fisheye{200, Equisolid}), "fisheye:200:equisolid");
}

}  // namespace
}  // namespace chromeball::fisheye_test

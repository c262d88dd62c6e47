// SPDX-License-Identifier: Apache-2.0
// The fill of directions that no photograph shows.
#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/capture/assemble.h"
#include "probe/synth.h"

namespace chromeball::inpaint_blind_test {
namespace {

constexpr ImageSize kSize{128, 64};

// Blind within `radius` degrees of `centre`.
Assembly withHole(const Image& map, const dvec3& centre, double radius) {
  Assembly assembly{map, Image(map.width, map.height, 1)};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const dvec3 d = texelDirection({map.width, map.height}, x, y);
      const bool isBlind = glm::dot(d, centre) > std::cos(radius * kPiD / 180);
      *assembly.coverage.at(x, y) = isBlind ? 0.f : 1.f;
      if (isBlind) assembly.latLong.setRgb(x, y, Rgb(0));
    }
  return assembly;
}

const std::vector<dvec3> kCentres{{0, 0, -1}, {0, 0, 1},     {0, 1, 0},
                                  {0, -1, 0}, {0.6, 0, 0.8}, {0, 0.8, -0.6}};

TEST(InpaintBlind, ContinuesAConstant) {
  const Image map = constantProbe(kSize, Rgb(0.7f, 2, 1e5f));
  for (const dvec3& centre : kCentres) {
    Assembly assembly = withHole(map, centre, 30);
    inpaintBlind(assembly);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(assembly.latLong.at(x, y)[c] / map.at(x, y)[c], 1, 1e-5);
  }
}

// Under the stereographic projection from the point opposite to the hole's centre, powers of the
// complex coordinate are harmonic on the sphere: radius^m cos(m around) inside the rim, with radius
// = tan(angle / 2).
TEST(InpaintBlind, ContinuesAHarmonicFunction) {
  for (const dvec3& centre : kCentres) {
    const dvec3 side = glm::normalize(
        glm::cross(centre, std::fabs(centre.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
    const dvec3 other = glm::cross(centre, side);
    Image map(kSize.width, kSize.height, 3);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const dvec3 d = texelDirection(kSize, x, y);
        const double angle = std::acos(std::clamp(glm::dot(d, centre), -1.0, 1.0));
        const double r = std::min(std::tan(0.5 * angle) / std::tan(kPiD / 8), 2.0);
        const double around = std::atan2(glm::dot(d, other), glm::dot(d, side));
        map.setRgb(x, y, Rgb(vec3(5 + r * std::cos(around), 5 + r * r * std::sin(2 * around), 5)));
      }
    Assembly assembly = withHole(map, centre, 45);
    inpaintBlind(assembly);
    double largest = 0;
    for (size_t i = 0; i < map.texels.size(); ++i)
      largest = std::max(largest, double(std::fabs(assembly.latLong.texels[i] - map.texels[i])));
    EXPECT_LT(largest, 0.25) << centre.x << " " << centre.y << " " << centre.z;
  }
}

// Nothing shown is changed, and no filled texel is outside the range of the rest.
TEST(InpaintBlind, KeepsWhatIsShown) {
  const Image map = studioProbe(kSize);
  Assembly assembly = withHole(map, {0.6, 0, 0.8}, 50);
  const Assembly before = assembly;
  inpaintBlind(assembly);
  float least = 1e30f, most = 0;
  for (const float channel : map.texels)
    least = std::min(least, channel), most = std::max(most, channel);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Rgb color = assembly.latLong.rgb(x, y);
      if (*before.coverage.at(x, y) > 0) {
        ASSERT_EQ(color, map.rgb(x, y));
      } else {
        ASSERT_GE(color.x, least);
        ASSERT_LE(color.x, most);
      }
    }
}

TEST(FillBlind, WithAColourOrAMap) {
  const Image map = constantProbe(kSize, Rgb(1));
  Assembly colored = withHole(map, {0, 1, 0}, 30), mapped = colored, black = colored;
  fillBlind({.color = Rgb(3, 4, 5), .map = {}}, colored);
  fillBlind({.map = constantProbe({8, 4}, Rgb(7))}, mapped);
  fillBlind({.map = {}}, black);
  EXPECT_EQ(colored.latLong.rgb(5, 0), Rgb(3, 4, 5));
  EXPECT_EQ(mapped.latLong.rgb(5, 0), Rgb(7));
  EXPECT_EQ(black.latLong.rgb(5, 0), Rgb(0));
  for (const Assembly& assembly : {colored, mapped, black})
    EXPECT_EQ(assembly.latLong.rgb(5, 63), Rgb(1));
}

TEST(FillBlind, NeedsSomethingToContinue) {
  Assembly nothing = withHole(constantProbe(kSize, Rgb(1)), {0, 1, 0}, 181);
  EXPECT_THROW(inpaintBlind(nothing), InputError);
}

}  // namespace
}  // namespace chromeball::inpaint_blind_test

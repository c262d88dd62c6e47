// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace chromeball::texture_test {
namespace {

// A row of 8-bit greys.
TexelGrid row(const std::vector<uint8_t>& greys) {
  TexelGrid grid{int(greys.size()), 1, {}, {}};
  for (uint8_t g : greys) grid.texels8.push_back({g, g, g, g});
  return grid;
}

double srgbToLinear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(Texture, TexelCentresAreExact) {
  const TexelGrid grid = row({0, 51, 102, 255});
  for (const Filter filter : {Filter::Linear, Filter::Nearest}) {
    const Texture texture{&grid, Wrap::Repeat, Wrap::Repeat, filter, false};
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(texture.lookup({(i + 0.5f) / 4, 0.5f}).x, grid.texels8[size_t(i)][0] / 255.f,
                  1e-6f);
  }
}

TEST(Texture, LinearIsTheMeanHalfwayBetweenCentres) {
  const TexelGrid grid = row({0, 51, 102, 255});
  const Texture texture{&grid};
  EXPECT_NEAR(texture.lookup({0.25f, 0.5f}).x, 25.5f / 255, 1e-6f);
  EXPECT_NEAR(texture.lookup({0.3125f, 0.5f}).x, (0.75f * 51 + 0.25f * 0) / 255, 1e-6f);
}

TEST(Texture, BilinearInBothDirections) {
  TexelGrid grid{2, 2, {}, {vec4(0), vec4(1), vec4(2), vec4(7)}};
  const Texture texture{&grid};
  EXPECT_NEAR(texture.lookup({0.5f, 0.5f}).x, 2.5f, 1e-6f);
  EXPECT_NEAR(texture.lookup({0.75f, 0.25f}).x, 1, 1e-6f);  // u right
  EXPECT_NEAR(texture.lookup({0.25f, 0.75f}).x, 2, 1e-6f);  // v down
}

float wrapped(Wrap wrap, Filter filter, float u) {
  static const TexelGrid grid = row({0, 85, 170, 255});
  return Texture{&grid, wrap, Wrap::Repeat, filter, false}.lookup({u, 0.5f}).x * 3;
}

TEST(Texture, WrapsFarOutsideTheUnitSquare) {
  constexpr Filter kNearest = Filter::Nearest;
  for (int period = -5; period <= 5; ++period)
    for (int i = 0; i < 4; ++i) {
      const float u = float(period) + (float(i) + 0.5f) / 4;
      const float clamped = period < 0 ? 0 : period > 0 ? 3 : float(i);
      const float mirrored = period % 2 != 0 ? 3 - float(i) : float(i);
      for (const Filter filter : {kNearest, Filter::Linear}) {
        EXPECT_NEAR(wrapped(Wrap::Repeat, filter, u), i, 1e-5f);
        EXPECT_NEAR(wrapped(Wrap::ClampToEdge, filter, u), clamped, 1e-5f);
        EXPECT_NEAR(wrapped(Wrap::MirroredRepeat, filter, u), mirrored, 1e-5f);
      }
    }
}

TEST(Texture, LinearAcrossTheSeam) {
  EXPECT_NEAR(wrapped(Wrap::Repeat, Filter::Linear, 0), 1.5f, 1e-5f);  // between 3 and 0
  EXPECT_NEAR(wrapped(Wrap::Repeat, Filter::Linear, 1), 1.5f, 1e-5f);
  EXPECT_NEAR(wrapped(Wrap::ClampToEdge, Filter::Linear, 0), 0, 1e-5f);
  EXPECT_NEAR(wrapped(Wrap::ClampToEdge, Filter::Linear, 1), 3, 1e-5f);
  EXPECT_NEAR(wrapped(Wrap::MirroredRepeat, Filter::Linear, 0), 0, 1e-5f);
  EXPECT_NEAR(wrapped(Wrap::MirroredRepeat, Filter::Linear, 1), 3, 1e-5f);
}

TEST(Texture, SrgbMatchesItsClosedFormAndAlphaIsLinear) {
  std::vector<uint8_t> codes(256);
  for (int i = 0; i < 256; ++i) codes[size_t(i)] = uint8_t(i);
  const TexelGrid grid = row(codes);
  const Texture texture{&grid, Wrap::Repeat, Wrap::Repeat, Filter::Nearest, true};
  for (int i = 0; i < 256; ++i) {
    const vec4 c = texture.lookup({(i + 0.5f) / 256, 0.5f});
    EXPECT_NEAR(c.x, srgbToLinear(i / 255.0), 1e-6);
    EXPECT_NEAR(c.w, i / 255.0, 1e-6);
  }
}

TEST(Texture, SrgbOfDeepTexels) {
  for (int i = 0; i <= 5000; ++i) {
    const float c = float(i) / 5000;
    const TexelGrid grid{1, 1, {}, {vec4(c)}};
    const vec4 decoded =
        Texture{&grid, Wrap::Repeat, Wrap::Repeat, Filter::Linear, true}.lookup({0.5f, 0.5f});
    EXPECT_NEAR(decoded.x, srgbToLinear(c), 3e-6) << c;
    EXPECT_EQ(decoded.w, c);
  }
}

TEST(Texture, InterpolatesInLinearLight) {
  const TexelGrid grid = row({0, 255});
  const Texture texture{&grid, Wrap::ClampToEdge, Wrap::ClampToEdge, Filter::Linear, true};
  EXPECT_NEAR(texture.lookup({0.5f, 0.5f}).x, 0.5f, 1e-6f);
}

TEST(Texture, AnyCoordinateIsValid) {
  const TexelGrid grid = row({51, 102, 153});
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  for (const Wrap wrap : {Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat})
    for (const Filter filter : {Filter::Linear, Filter::Nearest}) {
      const Texture texture{&grid, wrap, wrap, filter, false};
      for (const float u : {3e38f, -3e38f, 1e10f, -1e-30f, -0.0f, 16777217.0f, -1e-8f}) {
        const vec4 c = texture.lookup({u, u});
        EXPECT_TRUE(c.x >= 0.2f - 1e-6f && c.x <= 0.6f + 1e-6f) << u;
      }
      for (const float u : {nan, inf, -inf}) EXPECT_NEAR(texture.lookup({u, 0}).x, 0.2f, 1e-6f);
    }
}

}  // namespace
}  // namespace chromeball::texture_test

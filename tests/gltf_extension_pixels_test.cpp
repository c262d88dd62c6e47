// SPDX-License-Identifier: Apache-2.0
// Sample models of material extensions, normal maps and UV sets: the pixels match the models'
// documentation.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "sample_model.h"

namespace chromeball::gltf_extension_pixels_test {
namespace {

const Probe& darkness() {
  static const Probe kBlack(constantProbe({2, 1}, Rgb(0)));
  return kBlack;
}

// Each cube emits twice as much as its left neighbour.
TEST(GltfPixels, EmissiveStrengthTest) {
  const auto scene = sampleModel("EmissiveStrengthTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  float strength = 1;
  for (float x : {-6.0f, -3.0f, 0.0f, 3.0f, 6.0f}) {
    const Rgb c =
        meanColor(squareView(*scene, {x, 0, 3}, 0.3f, 4, darkness(), smallRender(0, 0, 4, 0)));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(c[k], strength * Rgb(0.1f, 0.5f, 0.9f)[k], 1e-5f * strength) << x;
    strength *= 2;
  }
}

// With the second UV set the texture shows a green mark, with the first an error text.
TEST(GltfPixels, MultiUVTest) {
  const auto scene = sampleModel("MultiUVTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Image image = squareView(*scene, {0, 0, 2}, 1, 128, darkness(), smallRender(0, 0, 4, 0));
  int green = 0, white = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.rgb(x, y);
      green += c.y > 0.3f && c.y > 2 * c.z;
      white += c.x > 0.3f && c.z > 0.6f * c.x;
    }
  EXPECT_GT(green, 300);
  EXPECT_EQ(white, 0);
}

// Geometric bumps and normal-mapped bumps, in all orientations of their tangents, reflect the same
// environment, which is brighter at the top and at the right.
void expectSameBumps(const Scene& scene, const std::vector<float>& columns) {
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.4, 0.8, 0}));
  constexpr float kOffset = 0.035f;  // less than half of a bump's radius
  const auto patch = [&](float x, float y) {
    return luminance(
        meanColor(squareView(scene, {x, y, 0.5f}, 0.01f, 4, probe, smallRender(0, 0, 256, 1))));
  };
  const vec2 offsets[] = {{0, kOffset}, {kOffset, 0}, {0, -kOffset}, {-kOffset, 0}};
  for (const vec2& d : offsets) {
    const float geometry = patch(columns[0] + d.x, 0.8f + d.y);
    for (float y : {0.8f, 0.4f, 0.0f, -0.4f, -0.8f})
      for (float x : columns)
        EXPECT_NEAR(patch(x + d.x, y + d.y) / geometry, 1, 0.1f)
            << x << " " << y << " at " << d.x << " " << d.y;
  }
  const float above = patch(columns[0], 0.8f + kOffset), below = patch(columns[0], 0.8f - kOffset);
  EXPECT_GT(above, 1.3f * below);  // so that a flipped axis would be detected
}

TEST(GltfPixels, NormalTangentTest) {
  const auto scene = sampleModel("NormalTangentTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  expectSameBumps(*scene, {0.638f, 0.96f});
}

TEST(GltfPixels, NormalTangentMirrorTest) {
  const auto scene = sampleModel("NormalTangentMirrorTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  expectSameBumps(*scene, {0.299f, 0.618f, 0.942f, 1.263f});
}

// In each column, thickness, scale and attenuation distance give the same blue: Beer's law and two
// Fresnel transmissions.
TEST(GltfPixels, AttenuationTest) {
  auto scene = sampleModel("AttenuationTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  makeLamp(materialNamed(*scene, "FlatBackdrop"));
  const std::pair<float, float> columns[] = {
      {-3.5f, 0.25f}, {-2.0f, 0.5f}, {0.0f, 1.0f}, {2.5f, 1.5f}, {6.0f, 2.0f}};
  constexpr float kPass = 0.96f * 0.96f;
  for (const auto& [x, thickness] : columns) {
    const Rgb answer = glm::pow(Rgb(0.1f, 0.5f, 0.9f), Rgb(thickness));
    for (float y : {6.0f, 3.0f, 0.0f, -3.0f, -6.0f}) {
      const bool key = y == 6;  // a coloured sheet with the expected colour, without Fresnel
      const Rgb c = meanColor(
          squareView(*scene, {x, y, 3}, 0.05f, 8, darkness(), smallRender(0, 0, 256, 12)));
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(c[k] / (kPass * answer[k]), 1, key ? 0.06f : 0.03f) << x << " " << y;
    }
  }
}

// In front of a white lamp: the fractions of a sphere's pixels that are dark, that show the lamp
// directly, and that show it through two walls of the given colour.
struct Seen {
  float dark = 0, open = 0, tinted = 0;
};
Seen lookThrough(const Scene& scene, const vec2& centre, const Rgb& color) {
  const Image image =
      squareView(scene, {centre, 0.3f}, 0.06f, 48, darkness(), smallRender(0, 0, 64, 12));
  Seen seen;
  const float fraction = 1.0f / float(image.width * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.rgb(x, y);
      seen.dark += maxComponent(c) < 0.15f ? fraction : 0;
      seen.open += std::min({c.x, c.y, c.z}) > 0.95f ? fraction : 0;
      const Rgb twice = color * color;
      seen.tinted += glm::distance(c, twice) < 0.15f * maxComponent(twice) ? fraction : 0;
    }
  return seen;
}

// Columns: transmission, with holes, with a texture; rows: smooth, rough, partly metallic.
TEST(SlowGltfPixels, TransmissionTest) {
  auto scene = sampleModel("TransmissionTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  Material& cloth = materialNamed(*scene, "Cloth Backdrop");
  makeLamp(cloth);
  const Rgb yellow(0.8469f, 0.8714f, 0.0931f), green(0.15f, 0.8308f, 0.1912f),
      red(0.956f, 0.1779f, 0.0953f);
  const Seen plain = lookThrough(*scene, {-0.367f, 0.226f}, yellow);
  EXPECT_GT(plain.tinted, 0.99f);
  const Seen holes = lookThrough(*scene, {-0.133f, 0.229f}, green);
  EXPECT_GT(holes.open, 0.05f);
  EXPECT_GT(holes.tinted, 0.1f);
  const Seen stripes = lookThrough(*scene, {0.101f, 0.233f}, red);
  EXPECT_GT(stripes.dark, 0.2f);
  EXPECT_GT(stripes.tinted, 0.1f);
  const Seen metal = lookThrough(*scene, {-0.367f, -0.234f}, yellow);
  EXPECT_GT(metal.dark, 0.2f);
  EXPECT_GT(metal.tinted, 0.1f);
  const Seen rough = lookThrough(*scene, {-0.367f, 0.0f}, yellow);
  EXPECT_EQ(rough.dark, 0);
}

// The middle column has the highlights of both others: the base, attenuated by the coating, and the
// coating alone. Tiles are rendered one by one, because they would shadow each other.
TEST(SlowGltfPixels, ClearCoatTest) {
  auto scene = sampleModel("ClearCoatTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Probe probe(studioProbe({128, 64}));
  const std::vector<Instance> all = scene->instances;
  const auto tile = [&](const std::string& node, float x, float y) {
    scene->instances.clear();
    for (const Instance& i : all)
      if (scene->nodeNames[size_t(i.node)] == node) scene->instances.push_back(i);
    return squareView(*scene, {x, y, 3}, 0.9f, 4, probe, smallRender(0, 0, 4096, 1));
  };
  const std::pair<std::string, float> rows[] = {{"", 5.25f},     {"R1_", 3.15f},  {"R2_", 1.05f},
                                                {"R3_", -1.05f}, {"R5_", -3.15f}, {"R4_", -5.25f}};
  for (const auto& [row, y] : rows) {
    const Image base = tile(row + "BaseLayerSample", -2.1f, y),
                coated = tile(row + "ClearCoatSample", 0, y),
                coat = tile(row + "CoatOnlySample", 2.1f, y);
    float both = 0, seen = 0, more = 0;
    for (int j = 0; j < base.height; ++j)
      for (int i = 0; i < base.width; ++i) {
        const float b = luminance(base.rgb(i, j)), c = luminance(coated.rgb(i, j)),
                    k = luminance(coat.rgb(i, j));
        both += b + k, seen += c, more += std::fabs(c - b);
        if (row == "R1_") continue;  // its coating is alpha-blended
        EXPECT_LT(c, 1.1f * (b + k)) << y << " " << i << " " << j;
        EXPECT_GT(c, 0.8f * b + 0.9f * k) << y << " " << i << " " << j;
      }
    if (row != "R1_") {
      EXPECT_NEAR(seen / both, 0.95f, 0.05f) << y;
    }
    EXPECT_GT(more, 0.03f * seen) << y;
  }
}

}  // namespace
}  // namespace chromeball::gltf_extension_pixels_test

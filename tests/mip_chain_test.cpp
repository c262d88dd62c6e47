// SPDX-License-Identifier: Apache-2.0
// Texture filtering: mip levels are means; renders have neither aliasing nor blur.
#include "scene/texture.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::mip_chain_test {
namespace {

TexelGrid randomGrid(int width, int height) {
  TexelGrid grid{width, height, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    const uint64_t bits = hash(uint64_t(i));
    grid.texelsFloat.push_back({toUnit(uint32_t(bits)), toUnit(uint32_t(bits >> 32)), 0.5f, 1});
  }
  return grid;
}

vec4 mean(const TexelGrid& grid) {
  glm::dvec4 sum(0);
  for (const vec4& t : grid.texelsFloat) sum += glm::dvec4(t);
  return vec4(sum / double(grid.texelsFloat.size()));
}

TEST(MipChain, EveryLevelHasTheMeanOfTheTexture) {
  for (const auto& [width, height] : {std::pair{8, 4}, {7, 5}, {1, 9}, {31, 2}}) {
    const TexelGrid grid = randomGrid(width, height);
    const std::vector<TexelGrid> levels = makeMipLevels(grid, false);
    for (const TexelGrid& level : levels) {
      EXPECT_EQ(level.texelsFloat.size(), size_t(level.width) * size_t(level.height));
      EXPECT_NEAR(glm::distance(mean(level), mean(grid)), 0, 1e-6) << width << "x" << level.width;
    }
    EXPECT_EQ(levels.back().width * levels.back().height, 1);
  }
  EXPECT_TRUE(makeMipLevels(randomGrid(1, 1), false).empty());
}

TEST(MipChain, AveragesInLinearLight) {
  TexelGrid grid{2, 2, {{0, 0, 0, 0}, {255, 255, 0, 255}, {255, 255, 0, 0}, {0, 255, 0, 255}}, {}};
  // Half the light has the sRGB code 188, three quarters 225; alpha is linear.
  const std::array<uint8_t, 4> encoded{188, 225, 0, 128}, linear{128, 191, 0, 128};
  EXPECT_EQ(makeMipLevels(grid, true).at(0).texels8.at(0), encoded);
  EXPECT_EQ(makeMipLevels(grid, false).at(0).texels8.at(0), linear);
  for (int code = 0; code < 256; ++code) {  // uniform textures do not change
    const uint8_t c = uint8_t(code);
    const TexelGrid even{2, 1, {{c, c, c, c}, {c, c, c, c}}, {}};
    const std::array<uint8_t, 4> same{c, c, c, c};
    EXPECT_EQ(makeMipLevels(even, true)[0].texels8[0], same);
  }
}

// Opaque white next to transparent black: the mean is white with alpha 1/2.
const TexelGrid kHoles{
    2, 2, {{255, 255, 255, 255}, {0, 0, 0, 0}, {0, 0, 0, 0}, {255, 255, 255, 255}}, {}};

TEST(MipChain, TransparentTexelsDoNotTint) {
  const std::array<uint8_t, 4> white{255, 255, 255, 128}, grey{128, 128, 128, 128};
  EXPECT_EQ(makeMipLevels(kHoles, false, true)[0].texels8[0], white);
  EXPECT_EQ(makeMipLevels(kHoles, false)[0].texels8[0], grey);
  // Weighted by alpha at every level; the plain mean where alpha is 0.
  TexelGrid oddWidth{3, 1, {}, {vec4(1, 0, 0, 0.75f), vec4(0, 1, 0, 0.25f), vec4(0, 0, 1, 0)}};
  const vec4 mean = makeMipLevels(oddWidth, false, true)[0].texelsFloat[0];
  EXPECT_NEAR(glm::distance(mean, vec4(0.75f, 0.25f, 0, 1 / 3.0f)), 0, 1e-6);
  for (vec4& texel : oddWidth.texelsFloat) texel.w = 0;
  const vec4 nothing = makeMipLevels(oddWidth, false, true)[0].texelsFloat[0];
  EXPECT_NEAR(glm::distance(nothing, vec4(vec3(1 / 3.0f), 0)), 0, 1e-6);
  // Opaque textures are filtered without weights, with the same bits.
  TexelGrid opaque{4, 2, {}, {}};
  for (int i = 0; i < 8; ++i)
    opaque.texels8.push_back({uint8_t(hash(uint64_t(i))), uint8_t(i * 30), 7, 255});
  EXPECT_EQ(makeMipLevels(opaque, true, true)[0].texels8, makeMipLevels(opaque, true)[0].texels8);
}

TEST(MipChain, LookupsAreWeightedByAlphaIfTheTextureHasTheFlag) {
  Texture texture{&kHoles};
  texture.mipLevels = std::make_shared<std::vector<TexelGrid>>(makeMipLevels(kHoles, false, true));
  EXPECT_NEAR(texture.lookup({0.5f, 0.5f}).x, 0.5f, 1e-6);
  texture.weightedByAlpha = true;
  for (const float texels : {1.0f, 1.7f, 3.0f, 64.0f})
    for (const vec2 uv : {vec2(0.5f), vec2(0.3f, 0.6f), vec2(0.9f, 0.1f)}) {
      const vec4 seen = texture.lookup(uv, texels);
      EXPECT_NEAR(seen.x, 1, 1e-5) << texels;
      EXPECT_GT(seen.w, 0);
    }
  EXPECT_EQ(texture.lookup({0.25f, 0.75f}), vec4(0));  // centre of a transparent texel
}

// A model with a chequered alpha texture seen from far away: half of it is opaque white, half shows
// the black behind it. The same image as an opaque texture is grey; sRGB does not change 0 and 1.
TEST(MipChain, ChequeredAlphaIsHalfWhiteForAnyNumberOfSamples) {
  constexpr int kSide = 64;
  std::vector<uint8_t> texels;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) texels.insert(texels.end(), 4, (x + y) % 2 ? 255 : 0);
  for (const char* mode : {"BLEND", "MASK", "OPAQUE"}) {
    GltfWriter w;
    w.write("a.png", encodePng(kSide, kSide, 4, texels));
    w.root["images"] = {{{"uri", "a.png"}}};
    w.root["textures"] = {{{"source", 0}}};
    for (const char* alphaMode : {mode, "OPAQUE", "BLEND"})  // textures that share the image
      w.add("materials", {{"alphaMode", alphaMode},
                          {"doubleSided", true},
                          {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}},
                          {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const auto square = [&](int material, float x) {
      const int positions = w.vec3s({x - 1, -1, 0, x + 1, -1, 0, x + 1, 1, 0, x - 1, 1, 0});
      const int uvs = w.vec2s({0, 0, 8, 0, 8, 8, 0, 8});
      w.add("nodes",
            {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                              {"indices", w.indices({0, 1, 2, 0, 2, 3})},
                              {"material", material}})}});
    };
    square(0, 0), square(1, 10), square(2, 20);
    const Scene scene = w.load();
    Camera camera;
    camera.orthographic = true;
    camera.halfHeight = 0.9f;
    camera.position = {0, 0, 5};
    for (const int samples : {4, 64, 512}) {
      const float mean = meanColor(renderScene(scene, camera, Probe(Image(2, 1, 3)), "bsdf",
                                               smallRender(24, 24, samples, 0))
                                       .film.mean())
                             .x;
      EXPECT_NEAR(mean, 0.5f, samples == 4 ? 0.03f : 0.01f) << mode << " " << samples;
    }
  }
}

TEST(MipChain, LookupGoesFromBilinearToTheMean) {
  const TexelGrid grid = randomGrid(16, 16);
  Texture texture{&grid};
  texture.mipLevels = std::make_shared<std::vector<TexelGrid>>(makeMipLevels(grid, false));
  const vec2 uv(0.3f, 0.6f);
  EXPECT_EQ(texture.lookup(uv, 0), texture.lookup(uv));
  EXPECT_EQ(texture.lookup(uv, 1), texture.lookup(uv));
  for (int level = 1; level <= 4; ++level) {
    const Texture alone{&(*texture.mipLevels)[size_t(level) - 1]};
    const float texels = std::pow(4.0f, float(level));
    EXPECT_NEAR(glm::distance(texture.lookup(uv, texels), alone.lookup(uv)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(texture.lookup(uv, texels * 0.99999f), alone.lookup(uv)), 0, 1e-3);
  }
  EXPECT_NEAR(glm::distance(texture.lookup(uv, 1e30f), mean(grid)), 0, 1e-6);
  EXPECT_NEAR(glm::distance(texture.lookup(uv, INFINITY), mean(grid)), 0, 1e-6);
}

// An emitting checkerboard up to the horizon: squares of 1 m and 8 texels.
Scene checkerboard(bool filtered) {
  Scene scene;
  constexpr int kSide = 64;
  auto grid = std::make_unique<TexelGrid>(TexelGrid{kSide, kSide, {}, {}});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const uint8_t c = (x / 8 + y / 8) % 2 ? 255 : 0;
      grid->texels8.push_back({c, c, c, 255});
    }
  Texture texture{grid.get()};
  if (filtered)
    texture.mipLevels = std::make_shared<std::vector<TexelGrid>>(makeMipLevels(*grid, false));
  scene.grids.push_back(std::move(grid));
  scene.textures.push_back(texture);
  Material glow = lambert(Rgb(0));
  glow.emission = Rgb(1);
  glow.emissiveTexture.texture = 0;
  Mesh floor;
  floor.positions = {{-400, 0, 400}, {400, 0, 400}, {400, 0, -400}, {-400, 0, -400}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  floor.uvs = {{{0, 0}, {100, 0}, {100, 100}, {0, 100}}};
  addMesh(scene, addMaterial(scene, glow), std::move(floor));
  return scene;
}

// Seen from a height of two metres towards the horizon, or from far above.
std::vector<double> seen(bool steep, bool filtered, uint32_t samples, uint64_t seed,
                         std::optional<double> noiseLimit = {}) {
  const Camera camera = steep ? Camera::lookAt({3, 150, 10}, {0.4f, 0, -50}, {0, 1, 0}, 0.7f)
                              : Camera::lookAt({0.3f, 2, 0}, {5, 0, -40}, {0, 1, 0}, 0.1f);
  const Probe black(Image(2, 1, 3));
  RenderSettings settings = smallRender(40, 30, samples, 0, seed);
  settings.noiseLimit = noiseLimit;
  const Image image =
      renderScene(checkerboard(filtered), camera, black, "bsdf", settings).film.mean();
  std::vector<double> greys;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) greys.push_back(image.rgb(x, y).x);
  return greys;
}

double rmsDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

// The contrast of the image as a fraction of the reference's.
double contrast(const std::vector<double>& image, const std::vector<double>& reference) {
  double both = 0, own = 0;
  for (size_t i = 0; i < image.size(); ++i) {
    both += (image[i] - 0.5) * (reference[i] - 0.5);
    own += (reference[i] - 0.5) * (reference[i] - 0.5);
  }
  return both / own;
}

TEST(SlowMipChain, AFarCheckerboardNeitherAliasesNorBlurs) {
  for (const bool steep : {false, true}) {
    const auto reference = seen(steep, false, 2048, 1);
    const auto few = seen(steep, true, 16, 2), fewPoints = seen(steep, false, 16, 2);
    const auto many = seen(steep, true, 1024, 3), manyPoints = seen(steep, false, 1024, 3);
    // The error of unfiltered lookups is 0.065 and 0.099, of filtered ones 0.032 and 0.005.
    EXPECT_LT(rmsDifference(few, reference),
              (steep ? 0.1 : 0.6) * rmsDifference(fewPoints, reference));
    EXPECT_LT(rmsDifference(many, reference), 1.1 * rmsDifference(manyPoints, reference));
    if (steep) continue;  // uniform grey
    EXPECT_GT(contrast(few, reference), 0.97);
    EXPECT_NEAR(contrast(many, reference), 1, 0.002);
    // The same sharpness if the number of samples is not known in advance.
    EXPECT_NEAR(contrast(seen(steep, true, 1024, 4, 1e-9), reference), 1, 0.003);
  }
}

}  // namespace
}  // namespace chromeball::mip_chain_test

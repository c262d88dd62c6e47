// SPDX-License-Identifier: Apache-2.0
// Triangles of emissive textures as lights: each by what its own texels emit.
#include "lighting/emission_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hypothesis.h"
#include "lighting/emitters.h"
#include "scene/surface.h"
#include "test_scene.h"

namespace chromeball::emission_map_test {
namespace {

// `lit`: of each texel.
const Texture& addTexture(Scene& scene, int width, int height, const auto& lit) {
  TexelGrid grid{width, height, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const uint8_t code = lit(x, y) ? 255 : 0;
      grid.texels8.push_back({code, code, code, 255});
    }
  scene.grids.push_back(std::make_unique<TexelGrid>(std::move(grid)));
  scene.textures.push_back({scene.grids.back().get()});
  return scene.textures.back();
}

Material lamp() {
  Material material = lambert(Rgb(0));
  material.emission = Rgb(2);
  material.emissiveTexture.texture = 0;
  return material;
}

vec2 randomCoordinates(std::mt19937& random, float extent) {
  std::uniform_real_distribution<float> number(-extent, extent);
  const float x = number(random);
  return {x, number(random)};
}

// Textures with few lit texels, of any size, wrap and filter; triangles of any size and place, some
// far from 0. Where the map has 0, no lookup finds light; where lookups find light, it has some.
TEST(EmissionMap, BlackTrianglesAreBlackAtAllLookups) {
  std::mt19937 random(7);
  const auto below = [&](int n) { return int(random() % unsigned(n)); };
  int black = 0, lit = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Scene scene;
    const int width = 1 + below(trial % 50 == 0 ? 1200 : 40), height = 1 + below(40);
    const int litX = below(width), litY = below(height);
    addTexture(scene, width, height, [&](int x, int y) { return x == litX && y == litY; });
    Texture& texture = scene.textures[0];
    texture.wrapS = Wrap(below(3)), texture.wrapT = Wrap(below(3));
    texture.filter = Filter(below(2));
    Material material = lamp();
    TextureSlot& slot = material.emissiveTexture;
    if (below(2)) {
      const float angle = float(below(360)), scale = 0.1f + 0.1f * float(below(30));
      slot.uvRow0 = scale * vec2(std::cos(angle), std::sin(angle));
      slot.uvRow1 = scale * vec2(-std::sin(angle), std::cos(angle));
      slot.uvOffset = randomCoordinates(random, 2);
    }
    const vec2 place = randomCoordinates(random, below(5) ? 1.5f : 300.0f);
    const float extent = std::exp2(-float(below(8)));
    Mesh mesh;
    mesh.uvs = {{}};
    for (int i = 0; i < 3; ++i) mesh.uvs[0].push_back(place + randomCoordinates(random, extent));
    const Triangle triangle{0, 1, 2};
    const double mean = EmissionMap(scene, material).mean(mesh, triangle);
    ++(mean > 0 ? lit : black);
    ASSERT_TRUE(std::isfinite(mean) && mean >= 0 && mean <= 2.0001) << trial;
    if (mean > 0) continue;
    std::uniform_real_distribution<float> number(0, 1);
    for (int i = 0; i < 200; ++i) {
      vec2 b(number(random), number(random));
      if (b.x + b.y > 1) b = vec2(1) - b;
      const vec2 uv =
          (1 - b.x - b.y) * mesh.uvs[0][0] + b.x * mesh.uvs[0][1] + b.y * mesh.uvs[0][2];
      ASSERT_EQ(Rgb(texture.lookup(slot.transform(uv))), Rgb(0)) << trial;
    }
  }
  EXPECT_GT(black, 500);
  EXPECT_GT(lit, 500);
}

TEST(EmissionMap, TheMeanOfTrianglesAlongOneColour) {
  Scene scene;
  addTexture(scene, 64, 64, [](int x, int) { return x >= 32; });
  Mesh mesh;
  mesh.uvs = {{{0.6f, 0.1f}, {0.9f, 0.1f}, {0.6f, 0.9f}, {0.1f, 0.1f}, {0.4f, 0.1f}, {0.1f, 0.9f}}};
  const Material material = lamp();
  const EmissionMap map(scene, material);
  EXPECT_NEAR(map.mean(mesh, {0, 1, 2}), 2, 1e-6);  // the largest
  EXPECT_EQ(map.mean(mesh, {3, 4, 5}), 0);
  mesh.uvs[0][5] = vec2(NAN, 0);
  EXPECT_GT(map.mean(mesh, {3, 4, 5}), 0);
}

// A floor under a lamp of 16 x 16 quads, of whose texture one part in 64 is lit, has the light of a
// lamp of that part alone, for light samples, BSDF samples and both; and no light sample of it is
// black.
class TexturedLamp : public testing::Test {
 protected:
  static constexpr int kQuads = 16;

  TexturedLamp() {
    for (Scene* scene : {&whole_, &part_}) {
      Material floor = lambert(Rgb(0.5f));
      addQuad(*scene, addMaterial(*scene, floor), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    }
    addTexture(whole_, 8, 8, [](int x, int y) { return x == 5 && y == 2; });
    whole_.textures[0].filter = Filter::Nearest;
    Material plain = lamp();
    plain.emissiveTexture = {};
    const int material = addMaterial(whole_, plain);
    const float side = 2.0f / kQuads;
    for (int y = 0; y < kQuads; ++y)
      for (int x = 0; x < kQuads; ++x) {
        addQuad(whole_, material, {-1 + side * float(x), 1, -1 + side * float(y)}, {side, 0, 0},
                {0, 0, side});
        Mesh& mesh = whole_.meshes.edit(whole_.meshes.size() - 1);
        const vec2 corner = vec2(x, y) / float(kQuads), u(1.0f / kQuads, 0), v(0, 1.0f / kQuads);
        mesh.uvs = {{corner, corner + u, corner + u + v, corner + v}};
      }
    whole_.materials[size_t(material)] = lamp();
    addQuad(part_, addMaterial(part_, plain), {-1 + 5 * 0.25f, 1, -1 + 2 * 0.25f}, {0.25f, 0, 0},
            {0, 0, 0.25f});
  }

  static Moments radiance(const Scene& scene, Mis mis, const char* strategy) {
    const Camera camera = Camera::lookAt({0, 0.5f, 1.2f}, {0, 0, 0}, {0, 1, 0}, 0.2f);
    static const Probe kBlack(Image(2, 1, 3));
    std::vector<double> means;
    for (uint64_t seed = 0; seed < 8; ++seed) {
      RenderSettings settings = smallRender(4, 4, 256, 1, seed);
      settings.mis = mis;
      means.push_back(
          meanColor(renderScene(scene, camera, kBlack, strategy, settings).film.mean()).y);
    }
    return Moments::of(means);
  }

  Scene whole_, part_;
};

TEST_F(TexturedLamp, LightsAsItsLitPart) {
  const Moments expected = radiance(part_, Mis::Balance, "importance");
  for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
    EXPECT_NEAR(radiance(whole_, mis, "importance").mean / expected.mean, 1, 0.02) << int(mis);
}

TEST_F(TexturedLamp, OnlyTrianglesThatTheLitTexelTouchesAreChosen) {
  const auto emitters = Emitters::make(whole_);
  // The texel covers 2 x 2 quads; bilinear lookups of their neighbours may read it.
  double lit = 0, all = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double choice = number(random);
    const Emitters::Point point = emitters->choose(choice, float(number(random)));
    const int quad = int(point.instance) - 1, x = quad % kQuads, y = quad / kQuads;
    EXPECT_TRUE(x >= 8 && x <= 13 && y >= 2 && y <= 7) << x << ", " << y;
    EXPECT_GT(emitters->pdf(point.instance, point.triangle, 1, 1), 0);
    EXPECT_FALSE(emitters->knowsAsBlack(point.instance, point.triangle));
    lit += x >= 10 && x <= 11 && y >= 4 && y <= 5, ++all;
  }
  EXPECT_GT(lit / all, 0.08);
  EXPECT_EQ(emitters->pdf(1, 0, 1, 1), 0);  // a corner of the lamp
  EXPECT_TRUE(emitters->knowsAsBlack(1, 0));
  EXPECT_EQ(emitters->pdf(0, 0, 1, 1), 0);  // the floor
}

}  // namespace
}  // namespace chromeball::emission_map_test

// SPDX-License-Identifier: Apache-2.0
// Lamps that are not all there: what of them light samples find is what the BSDF's rays find.
#include <gtest/gtest.h>

#include "composite/compose.h"
#include "composite/layers.h"
#include "composite/render_composite.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {
namespace {

const Probe& blackProbe() {
  static const Probe kBlack(Image(2, 1, 3));
  return kBlack;
}

Material lampOfAlpha(AlphaMode mode, float alpha) {
  Material m = lambert(Rgb(0));
  m.emission = Rgb(3);
  m.alphaMode = mode;
  m.baseColor.w = alpha;
  return m;
}

// A glossy floor under a lamp of 2 m x 2 m, which hangs 1 m above.
Scene floorUnder(const Material& lamp) {
  Scene scene;
  Material floor = lambert(Rgb(0.5f));
  floor.specular = 1;
  floor.roughness = 0.4f;
  addQuad(scene, addMaterial(scene, floor), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  addQuad(scene, addMaterial(scene, lamp), {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  return scene;
}

Moments light(const Scene& scene, Mis mis, int samples = 256) {
  const Camera camera = Camera::lookAt({0, 0.5f, 1.2f}, {0, 0, 0}, {0, 1, 0}, 0.2f);
  std::vector<double> means;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    RenderSettings settings = smallRender(4, 4, samples, 1, seed);
    settings.mis = mis;
    means.push_back(
        meanColor(renderScene(scene, camera, blackProbe(), "importance", settings).film.mean()).y);
  }
  return Moments::of(means);
}

void expectFraction(const Scene& scene, const Scene& whole, double fraction, const char* what) {
  const double all = light(whole, Mis::Balance, 1024).mean;
  for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
    EXPECT_NEAR(light(scene, mis).mean / all, fraction, 0.03) << what << " " << int(mis);
}

const Scene& wholeLamp() {
  static const Scene kWhole = floorUnder(lampOfAlpha(AlphaMode::Opaque, 1));
  return kWhole;
}

TEST(LampAlpha, BlendedLampsLendTheirShare) {
  for (const float alpha : {0.0f, 0.3f, 1.0f})
    expectFraction(floorUnder(lampOfAlpha(AlphaMode::Blend, alpha)), wholeLamp(), alpha, "blend");
  // Of a material that is opaque, alpha says nothing.
  expectFraction(floorUnder(lampOfAlpha(AlphaMode::Opaque, 0.3f)), wholeLamp(), 1, "opaque");
}

TEST(LampAlpha, MasksShowAllOrNothing) {
  expectFraction(floorUnder(lampOfAlpha(AlphaMode::Mask, 0.4f)), wholeLamp(), 0,
                 "below the cutoff");
  expectFraction(floorUnder(lampOfAlpha(AlphaMode::Mask, 0.6f)), wholeLamp(), 1, "above");
}

TEST(LampAlpha, VertexColoursCount) {
  Scene scene = floorUnder(lampOfAlpha(AlphaMode::Blend, 0.8f));
  scene.meshes[1].colors.assign(4, vec4(1, 1, 1, 0.5f));
  expectFraction(scene, wholeLamp(), 0.4, "vertex colour");
}

// One half of the lamp is cut away by its texture: what shines is a lamp of half the size.
TEST(LampAlpha, TexturesCount) {
  Scene half;
  half = floorUnder(lampOfAlpha(AlphaMode::Opaque, 1));
  half.meshes[1].positions = {{-1, 1, -1}, {0, 1, -1}, {0, 1, 1}, {-1, 1, 1}};
  for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
    Scene scene = floorUnder(lampOfAlpha(mode, 1));
    scene.grids.push_back(
        std::make_unique<TexelGrid>(TexelGrid{2, 1, {{0, 0, 0, 255}, {0, 0, 0, 0}}, {}}));
    Texture texture{scene.grids[0].get()};
    texture.filter = Filter::Nearest;
    texture.wrapS = texture.wrapT = Wrap::ClampToEdge;
    scene.textures.push_back(texture);
    scene.materials[1].baseColorTexture.texture = 0;
    scene.meshes[1].uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    expectFraction(scene, half, 1, "texture");
  }
}

// Lamps are chosen by what is there of them, but none that may shine is left out.
TEST(LampAlpha, TheChoiceOfLampsKnowsAlpha) {
  EXPECT_EQ(Emitters::make(floorUnder(lampOfAlpha(AlphaMode::Blend, 0))), nullptr);
  Scene scene = floorUnder(lampOfAlpha(AlphaMode::Blend, 0.1f));
  const auto emitters = Emitters::make(scene);
  addQuad(scene, addMaterial(scene, lampOfAlpha(AlphaMode::Opaque, 1)), {3, 1, -1}, {2, 0, 0},
          {0, 0, 2});
  const auto both = Emitters::make(scene);
  EXPECT_NEAR(both->pdf(1, 1, 1) / both->pdf(2, 1, 1), 0.1f, 1e-6f);
  EXPECT_GT(Emitters::make(floorUnder(lampOfAlpha(AlphaMode::Mask, 0.1f)))->pdf(1, 1, 1), 0);
}

// A composite's lamp, put in: it changes alpha of what an opaque one changes.
TEST(LampAlpha, CompositesCountIt) {
  const auto change = [](const Material& lamp) {
    const Scene scene = floorUnder(lamp);
    const ObjectMask isObject{false, true};
    const World world(scene, rayMasks(isObject));
    const RenderSettings settings = smallRender(8, 8, 1024, 1);
    const auto lighting = makeStrategy("importance", blackProbe(), settings.mis, "test");
    const std::atomic<bool> stop = false;
    const Camera camera = Camera::lookAt({0, 0.5f, 1.2f}, {0, 0, 0}, {0, 1, 0}, 0.2f);
    const CompositeRender r = renderComposite(
        world, camera, *lighting, Image(8, 8, 3), settings, Passes::One, false, [](double) {},
        stop);
    return meanColor(compositeLayer(r.film, CompositeLayer::Difference)).y;
  };
  const float whole = change(lampOfAlpha(AlphaMode::Opaque, 1));
  EXPECT_NEAR(change(lampOfAlpha(AlphaMode::Blend, 0.3f)) / whole, 0.3f, 0.02f);
  EXPECT_EQ(change(lampOfAlpha(AlphaMode::Blend, 0)), 0);
}

// A lamp of a thousand millionth of the power is found where its share of the numbers is, which no
// float reaches.
TEST(EmitterChoice, TheWeakestLampIsWithinReach) {
  Scene scene;
  Material strong = lambert(Rgb(0)), weak = strong;
  strong.emission = Rgb(1), weak.emission = Rgb(1e-9f);
  addQuad(scene, addMaterial(scene, strong), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  addQuad(scene, addMaterial(scene, weak), {5, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto emitters = Emitters::make(scene);
  EXPECT_EQ(emitters->sample(1 - 0.4e-9, 0.5f).instance, 1u);
  EXPECT_EQ(emitters->sample(1 - 1.1e-9, 0.5f).instance, 0u);
  const Emitters::Point p = emitters->sample(1 - 0.25e-9, 0.5f);  // in the middle of its triangle
  EXPECT_GT(p.position.x, 5.01f);
  EXPECT_LT(p.position.x, 5.99f);
}

// The numbers that choose are uniform to the last of 53 bits, and agree with the coarser ones.
TEST(EmitterChoice, FineNumbersAreUniformBelowTheTable) {
  const SobolTable table(1024, 16, 7);
  PixelSampler sampler(table, 3);
  std::vector<double> low(16);
  for (uint32_t pixel = 0; pixel < 16; ++pixel) {
    sampler.startPixel(pixel, 5, 0);
    for (uint32_t i = 0; i < 1024; ++i) {
      sampler.startSample(i);
      sampler.startVertex(0);
      const double fine = sampler.getFine1(dimension::kEmitter) * 0x1p32;
      EXPECT_EQ(uint32_t(fine), sampler.bits(dimension::kEmitter));
      EXPECT_LT(fine, 0x1p32);
      ++low[size_t((fine - std::floor(fine)) * 16)];
    }
  }
  const std::vector<double> expected(16, 1024);
  EXPECT_GT(chiSquareTest(low, expected, 1).pValue, 1e-4);
}

}  // namespace
}  // namespace chromeball

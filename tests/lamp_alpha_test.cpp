// SPDX-License-Identifier: Apache-2.0
// Emitters with alpha below 1: light samples and BSDF samples must find the same light.
#include <gtest/gtest.h>

#include "composite/compose.h"
#include "composite/layers.h"
#include "composite/render_composite.h"
#include "hypothesis.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::lamp_alpha_test {
namespace {

const Probe& blackProbe() {
  static const Probe kBlack(Image(2, 1, 3));
  return kBlack;
}

Material lampMaterial(AlphaMode mode, float alpha) {
  Material m = lambert(Rgb(0));
  m.emission = Rgb(3);
  m.alphaMode = mode;
  m.baseColor.w = alpha;
  return m;
}

// A glossy floor, 1 m below a lamp of 2 m x 2 m.
Scene floorUnder(const Material& lamp) {
  Scene scene;
  Material floor = lambert(Rgb(0.5f));
  floor.specular = 1;
  floor.roughness = 0.4f;
  addQuad(scene, addMaterial(scene, floor), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  addQuad(scene, addMaterial(scene, lamp), {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  return scene;
}

Moments floorRadiance(const Scene& scene, Mis mis, int samples = 256) {
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

// The floor in `scene` has `fraction` of its radiance in `reference`, for every MIS weight.
void expectFraction(const Scene& scene, const Scene& reference, double fraction, const char* name) {
  const double all = floorRadiance(reference, Mis::Balance, 1024).mean;
  for (const Mis mis : {Mis::Off, Mis::Balance, Mis::Power})
    EXPECT_NEAR(floorRadiance(scene, mis).mean / all, fraction, 0.03) << name << " " << int(mis);
}

const Scene& opaqueLamp() {
  static const Scene kScene = floorUnder(lampMaterial(AlphaMode::Opaque, 1));
  return kScene;
}

TEST(LampAlpha, BlendModeScalesEmissionByAlpha) {
  for (const float alpha : {0.0f, 0.3f, 1.0f})
    expectFraction(floorUnder(lampMaterial(AlphaMode::Blend, alpha)), opaqueLamp(), alpha, "blend");
  // An opaque material ignores alpha.
  expectFraction(floorUnder(lampMaterial(AlphaMode::Opaque, 0.3f)), opaqueLamp(), 1, "opaque");
}

TEST(LampAlpha, MaskModeComparesAlphaWithTheCutoff) {
  expectFraction(floorUnder(lampMaterial(AlphaMode::Mask, 0.4f)), opaqueLamp(), 0,
                 "below the cutoff");
  expectFraction(floorUnder(lampMaterial(AlphaMode::Mask, 0.6f)), opaqueLamp(), 1, "above");
}

TEST(LampAlpha, VertexColoursScaleAlpha) {
  Scene scene = floorUnder(lampMaterial(AlphaMode::Blend, 0.8f));
  scene.meshes.edit(1).colors.assign(4, vec4(1, 1, 1, 0.5f));
  expectFraction(scene, opaqueLamp(), 0.4, "vertex colour");
}

// The texture's alpha is 0 on one half of the lamp, which must equal a lamp of half the size.
TEST(LampAlpha, TexturesScaleAlpha) {
  Scene half = floorUnder(lampMaterial(AlphaMode::Opaque, 1));
  half.meshes.edit(1).positions = {{-1, 1, -1}, {0, 1, -1}, {0, 1, 1}, {-1, 1, 1}};
  for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
    Scene scene = floorUnder(lampMaterial(mode, 1));
    scene.grids.push_back(
        std::make_unique<TexelGrid>(TexelGrid{2, 1, {{0, 0, 0, 255}, {0, 0, 0, 0}}, {}}));
    Texture texture{scene.grids[0].get()};
    texture.filter = Filter::Nearest;
    texture.wrapS = texture.wrapT = Wrap::ClampToEdge;
    scene.textures.push_back(texture);
    scene.materials[1].baseColorTexture.texture = 0;
    scene.meshes.edit(1).uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    expectFraction(scene, half, 1, "texture");
  }
}

// The probability of choosing an emitter is proportional to its alpha. Masked emitters keep a pdf
// above 0, because their texture may exceed the cutoff.
TEST(LampAlpha, EmitterPdfIsProportionalToAlpha) {
  EXPECT_EQ(Emitters::make(floorUnder(lampMaterial(AlphaMode::Blend, 0))), nullptr);
  Scene scene = floorUnder(lampMaterial(AlphaMode::Blend, 0.1f));
  const auto emitters = Emitters::make(scene);
  addQuad(scene, addMaterial(scene, lampMaterial(AlphaMode::Opaque, 1)), {3, 1, -1}, {2, 0, 0},
          {0, 0, 2});
  const auto both = Emitters::make(scene);
  EXPECT_NEAR(both->pdf(1, 0, 1, 1) / both->pdf(2, 0, 1, 1), 0.1f, 1e-6f);
  EXPECT_GT(Emitters::make(floorUnder(lampMaterial(AlphaMode::Mask, 0.1f)))->pdf(1, 0, 1, 1), 0);
}

// A lamp that is a synthetic object of a composite: the change of the plate is proportional to
// alpha.
TEST(LampAlpha, CompositesScaleTheDifferenceByAlpha) {
  const auto difference = [](const Material& lamp) {
    const Scene scene = floorUnder(lamp);
    const ObjectMask isObject{false, true};
    const World world(scene, rayMasks(isObject), allTables());
    const RenderSettings settings = smallRender(8, 8, 1024, 1);
    const auto lighting = makeStrategy("importance", blackProbe(), settings.mis, "test");
    const std::atomic<bool> stop = false;
    const Camera camera = Camera::lookAt({0, 0.5f, 1.2f}, {0, 0, 0}, {0, 1, 0}, 0.2f);
    const CompositeRender r = renderComposite(
        world, camera, *lighting, Image(8, 8, 3), settings, Passes::One, false, [](double) {},
        stop);
    return meanColor(compositeLayer(r.film(), CompositeLayer::Difference)).y;
  };
  const float opaque = difference(lampMaterial(AlphaMode::Opaque, 1));
  EXPECT_NEAR(difference(lampMaterial(AlphaMode::Blend, 0.3f)) / opaque, 0.3f, 0.02f);
  EXPECT_EQ(difference(lampMaterial(AlphaMode::Blend, 0)), 0);
}

// A lamp with 1e-9 of the total power has its interval of u within 1e-9 of 1, which a float cannot
// resolve.
TEST(EmitterChoice, ALampOf1e_9OfThePowerIsSampled) {
  Scene scene;
  Material strong = lambert(Rgb(0)), weak = strong;
  strong.emission = Rgb(1), weak.emission = Rgb(1e-9f);
  addQuad(scene, addMaterial(scene, strong), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  addQuad(scene, addMaterial(scene, weak), {5, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto emitters = Emitters::make(scene);
  EXPECT_EQ(emitters->choose(1 - 0.4e-9, 0.5f).instance, 1u);
  EXPECT_EQ(emitters->choose(1 - 1.1e-9, 0.5f).instance, 0u);
  const Emitters::Point p = emitters->choose(1 - 0.25e-9, 0.5f);  // inside its first triangle
  EXPECT_GT(p.position.x, 5.01f);
  EXPECT_LT(p.position.x, 5.99f);
}

// The 53-bit numbers for emitter choice agree with the table in their upper 32 bits and are uniform
// in the bits below.
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
}  // namespace chromeball::lamp_alpha_test

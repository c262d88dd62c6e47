// SPDX-License-Identifier: Apache-2.0
// Differential rendering: pixels that the objects do not affect equal the plate bit by bit.
#include "composite/compose.h"

#include <gtest/gtest.h>

#include "composite/layers.h"
#include "composite/local_scene.h"
#include "composite/render_composite.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::composite_test {
namespace {

// A scene in which some instances are synthetic objects and the others are the local scene.
struct Worlds {
  Scene scene;
  ObjectMask isObject;
  Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.4f, 0}, {0, 1, 0}, 0.7f);

  // Mark the instances that were added since the last call.
  void markRestLocal() { isObject.resize(scene.instances.size(), false); }
  void markRestObjects() { isObject.resize(scene.instances.size(), true); }
};

// In a time that does not grow with the square of the depth.
TEST(LocalScene, IsWhatIsBelowItsNodes) {
  constexpr int kNodes = 300'000, kLocal = 1000;
  Scene scene;
  for (int node = 0; node < kNodes; ++node) {
    scene.nodeNames.push_back(node == kLocal ? "local" : "");
    scene.nodeParents.push_back(node - 1);
    scene.instances.push_back({.node = node});
  }
  ObjectMask isObject = findObjects(scene, {{"local", "here"}}, "here");
  for (int node = 0; node < kNodes; ++node) ASSERT_EQ(isObject[size_t(node)], node < kLocal);
  std::ranges::reverse(scene.instances);  // the deepest first
  std::reverse(isObject.begin(), isObject.end());
  EXPECT_EQ(findObjects(scene, {{"local", "here"}}, "here"), isObject);
}

CompositeRender composite(const Worlds& w, const Probe& probe, const std::string& strategy,
                          const RenderSettings& settings, const Image& plate,
                          Passes passes = Passes::One) {
  const World world(w.scene, rayMasks(w.isObject), allTables());
  const auto lighting = makeStrategy(strategy, probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  return renderComposite(
      world, w.camera, *lighting, plate, settings, passes, true, [](double) {}, stop);
}

// Arbitrary values, so that rounding in any arithmetic shows.
Image noisyPlate(int width, int height) {
  Image plate(width, height, 3);
  for (size_t i = 0; i < plate.texels.size(); ++i) plate.texels[i] = toUnit(uint32_t(hash(i))) / 3;
  return plate;
}

Image sunnyProbe() {
  Image probe = gradientProbe({32, 16}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
  probe.setRgb(9, 3, Rgb(200, 150, 100));
  return probe;
}

// Objects: a red ball, a mirror ball, a transparent quad (veil) and a lamp. Local scene: a grey
// ground and a wall.
Worlds stillLife() {
  Worlds w;
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  Material wall;
  wall.baseColor = {0.6f, 0.6f, 0.7f, 1};
  wall.metallic = 0;
  wall.roughness = 0.4f;
  addQuad(w.scene, addMaterial(w.scene, wall), {-3, 0, -1.5f}, {6, 0, 0}, {0, 2, 0});
  w.markRestLocal();
  addSphere(w.scene, addMaterial(w.scene, lambert({0.8f, 0.1f, 0.1f})), {-0.8f, 0.5f, 0}, 0.5f, 16);
  Material mirror;
  mirror.roughness = 0;
  addSphere(w.scene, addMaterial(w.scene, mirror), {0.6f, 0.5f, -0.4f}, 0.5f, 24);
  Material veil = lambert({0.9f, 0.4f, 0.4f});
  veil.alphaMode = AlphaMode::Blend;
  veil.baseColor.w = 0.4f;
  addQuad(w.scene, addMaterial(w.scene, veil), {0.2f, 0, 1}, {1, 0, 0}, {0, 0.8f, 0});
  Material lamp = lambert(Rgb(0.2f));
  lamp.emission = {4, 3, 2};
  addSphere(w.scene, addMaterial(w.scene, lamp), {-0.2f, 0.2f, 0.8f}, 0.2f, 12);
  w.markRestObjects();
  return w;
}

constexpr const char* kStrategies[] = {"bsdf",          "uniform",
                                       "importance",    "suns",
                                       "median-cut:16", "kollig-keller-strata:4",
                                       "penrose:32",    "irradiance-fit-ambient:4"};

// An object below the ground is invisible: the composite equals the plate bit by bit.
TEST(Composite, EqualsThePlateWhereObjectsChangeNothing) {
  Worlds w;
  Material ground = lambert(Rgb(0.5f));
  ground.specular = 1;
  ground.roughness = 0.3f;
  addQuad(w.scene, addMaterial(w.scene, ground), {-30, 0, 30}, {60, 0, 0}, {0, 0, -60});
  addSphere(w.scene, addMaterial(w.scene, lambert({0.2f, 0.7f, 0.3f})), {0.2f, 0.5f, 0}, 0.5f, 16);
  Material veil = lambert(Rgb(0.5f));
  veil.alphaMode = AlphaMode::Blend;
  veil.baseColor.w = 0.3f;
  for (float z : {1.0f, 1.1f, 1.2f})
    addQuad(w.scene, addMaterial(w.scene, veil), {-1, 0.1f, z}, {2, 0, 0}, {0, 1, 0});
  w.markRestLocal();
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.9f))), {0, -2, 0}, 1, 16);
  w.markRestObjects();

  const Image plate = noisyPlate(24, 16);
  for (const char* strategy : kStrategies) {
    const CompositeRender r =
        composite(w, Probe(sunnyProbe(), 25), strategy, smallRender(24, 16, 13, 6), plate);
    EXPECT_EQ(r.mean.texels, plate.texels) << strategy;
    for (CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio})
      EXPECT_EQ(compose(r.film(), r.mean, plate, mode).color.texels, plate.texels) << strategy;
    EXPECT_GT(luminance(meanColor(compositeLayer(r.film(), CompositeLayer::WithoutObjects))), 0.1f);
  }
}

// A single-sided local wall in front of an object turns its back to the camera: with one pass and
// with two, the camera sees the object and not the wall.
TEST(Composite, ObjectsAreVisibleThroughSingleSidedBacks) {
  Worlds w;
  w.camera = Camera::lookAt({0, 1, 4}, {0, 1, 0}, {0, 1, 0}, 0.5f);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  Material wall = lambert(Rgb(0.5f));
  wall.doubleSided = false;
  addQuad(w.scene, addMaterial(w.scene, wall), {3, 0, 2}, {-6, 0, 0}, {0, 3, 0});
  w.markRestLocal();
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {0, 1, 0}, 0.5f, 24);
  w.markRestObjects();
  const Probe probe(sunnyProbe());
  const Image plate = noisyPlate(16, 16);
  std::vector<Image> alphas;
  for (const Passes passes : {Passes::One, Passes::Two}) {
    const CompositeRender r =
        composite(w, probe, "importance", smallRender(16, 16, 16, 3), plate, passes);
    alphas.push_back(compositeLayer(r.film(), CompositeLayer::Alpha));
  }
  EXPECT_EQ(*alphas[0].at(8, 8), 1);
  EXPECT_EQ(alphas[0].texels, alphas[1].texels);
}

// A lamp of infinite radiance: its samples count as infinite, with one pass and with two.
TEST(Composite, InvalidSamplesAreCountedByCause) {
  Worlds w;
  w.camera = topCamera(6, 40);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.markRestLocal();
  Material lamp = lambert(Rgb(0));
  addSphere(w.scene, addMaterial(w.scene, lamp), {0, 1, 0}, 0.5f, 16);
  w.scene.materials.back().emission = Rgb(INFINITY);
  w.markRestObjects();
  for (const Passes passes : {Passes::One, Passes::Two}) {
    const CompositeRender r = composite(w, Probe(sunnyProbe()), "bsdf", smallRender(16, 16, 4, 0),
                                        noisyPlate(16, 16), passes);
    EXPECT_GT(r.result.invalid.of(Defect::Infinite), 0u);
    EXPECT_EQ(r.result.invalid.of(Defect::Nan), 0u);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        EXPECT_TRUE(std::isfinite(r.film().at(x, y).objects.x + r.film().at(x, y).difference.x));
  }
}

// A wall higher than the object confines its shadow and indirect light to one side.
TEST(Composite, ChangesNothingBehindAWall) {
  Worlds w;
  w.camera = topCamera(6, 40);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {0, 0, 3}, {0, 0, -6}, {0, 1, 0});
  w.markRestLocal();
  addSphere(w.scene, addMaterial(w.scene, lambert({0.9f, 0.1f, 0.1f})), {1, 0.4f, 0}, 0.4f, 16);
  w.markRestObjects();
  const Image plate = noisyPlate(32, 32);
  const CompositeRender r =
      composite(w, Probe(sunnyProbe()), "importance", smallRender(32, 32, 32, 6), plate);
  const Image difference = compositeLayer(r.film(), CompositeLayer::Difference);
  int changed = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      if (x < 15) {
        EXPECT_EQ(difference.rgb(x, y), Rgb(0));
      } else {
        changed += difference.rgb(x, y) != Rgb(0);
      }
  EXPECT_GT(changed, 300);
}

// L_obj and L_noobj equal plain renders of the scenes with and without objects, with the same
// random numbers.
TEST(Composite, LayersEqualPlainRenders) {
  Worlds w = stillLife();
  w.scene.materials.back().emission = Rgb(0);  // without emitters both use the same random numbers
  const Probe probe(sunnyProbe(), 25);
  RenderSettings settings = smallRender(32, 24, 16, 6);
  settings.guiding = Guiding::Off;  // learns different things in each render
  settings.hideProbe = true;
  const CompositeRender r = composite(w, probe, "importance", settings, noisyPlate(32, 24));

  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  for (CompositeLayer aov : {CompositeLayer::WithObjects, CompositeLayer::WithoutObjects}) {
    Worlds alone = stillLife();
    alone.scene.materials.back().emission = Rgb(0);
    if (aov == CompositeLayer::WithoutObjects)
      alone.scene.instances.resize(size_t(std::ranges::count(w.isObject, false)));
    const World world(alone.scene);
    const Image plain = render(
                            world, w.camera, *lighting, settings, [](double) {}, stop)
                            .film.mean();
    const Image ours = compositeLayer(r.film(), aov);
    for (size_t i = 0; i < plain.texels.size(); ++i)
      ASSERT_NEAR(ours.texels[i], plain.texels[i], 1e-5f * (1 + plain.texels[i]))
          << int(aov) << " " << i;
  }
}

// Sums of the composite over tiles, indexed [tile x 3 + channel][repeat].
std::vector<std::vector<double>> tileMeans(const Worlds& w, const char* strategy, Passes passes,
                                           int samples, uint64_t firstSeed) {
  constexpr int kSize = 24, kTile = 8, kRepeats = 12;
  const int tiles = kSize / kTile;
  std::vector<std::vector<double>> means(size_t(tiles * tiles * 3));
  const Probe probe(sunnyProbe(), 25);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const RenderSettings settings =
        smallRender(kSize, kSize, samples, 5, firstSeed + uint64_t(repeat));
    const CompositeRender r =
        composite(w, probe, strategy, settings, noisyPlate(kSize, kSize), passes);
    EXPECT_EQ(r.result.invalid.total(), 0u);
    for (int t = 0; t < tiles * tiles; ++t) {
      glm::dvec3 sum(0);
      for (int i = 0; i < kTile * kTile; ++i)
        sum += glm::dvec3(r.mean.rgb(t % tiles * kTile + i % kTile, t / tiles * kTile + i / kTile));
      for (int c = 0; c < 3; ++c) means[size_t(t * 3 + c)].push_back(sum[c]);
    }
  }
  return means;
}

// One pass with shared paths has the same expectation as the difference of two renders.
TEST(SlowComposite, OnePassAgreesWithTwo) {
  const Worlds w = stillLife();
  for (const char* strategy : {"importance", "suns", "median-cut:16"}) {
    const auto one = tileMeans(w, strategy, Passes::One, 16, 100);
    const auto two = tileMeans(w, strategy, Passes::Two, 32, 900);
    for (size_t i = 0; i < one.size(); ++i) {
      const double p = welchTest(Moments::of(one[i]), Moments::of(two[i]));
      EXPECT_GT(p, sidak(1e-3, int(one.size()) * 3)) << strategy << ", tile " << i / 3;
    }
  }
}

// An object's tinted sheet, or its front that passes light from behind, coincides with a rough pane
// of the local scene: without objects light crosses the pane alone.
TEST(SlowComposite, LayersOfAPlaceAreThoseOfTheWorld) {
  Material pane = lambert(Rgb(0.9f));
  pane.doubleSided = true;
  pane.roughness = 0.5f;
  pane.extended.emplace();
  pane.extended->transmission = 1;
  Material tinted = pane;
  tinted.roughness = 0;
  tinted.baseColor = {0.3f, 0.6f, 0.9f, 1};
  Material front = lambert({0.3f, 0.6f, 0.9f});
  front.doubleSided = false;
  front.singleSided = SingleSided::Light;
  // The order in the file decides which of the two a path meets first.
  for (const auto& [object, objectFirst] :
       {std::pair(tinted, true), {tinted, false}, {front, true}, {front, false}}) {
    Worlds w;
    w.camera = Camera::lookAt({0.5f, 0.4f, 1}, {0, 0, 0}, {0, 1, 0}, 0.7f);  // under the panes
    const auto addPane = [&](const Material& material) {                     // faces down
      addQuad(w.scene, addMaterial(w.scene, material), {-3, 0.5f, -3}, {6, 0, 0}, {0, 0, 6});
    };
    if (objectFirst) addPane(object), w.markRestObjects();
    addPane(pane);
    addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.7f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    w.markRestLocal();
    if (!objectFirst) addPane(object), w.markRestObjects();
    const auto one = tileMeans(w, "importance", Passes::One, 32, 100);
    const auto two = tileMeans(w, "importance", Passes::Two, 64, 900);
    for (size_t i = 0; i < one.size(); ++i)
      EXPECT_GT(welchTest(Moments::of(one[i]), Moments::of(two[i])),
                sidak(1e-3, 4 * int(one.size())))
          << "tile " << i / 3;
  }
}

// Adaptive passes take different numbers of samples of a pixel, and the layers are means all the
// same: the ratio is 1 on average on a surface that the objects do not change, and L_noobj equals a
// render without objects.
TEST(Composite, TwoAdaptivePassesAddMeans) {
  Worlds w;
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.markRestLocal();
  Material mirror;  // with noisy caustics, which attract the samples of the first pass
  mirror.roughness = 0.1f;
  addSphere(w.scene, addMaterial(w.scene, mirror), {0, 0.5f, 0.6f}, 0.5f, 24);
  w.markRestObjects();
  constexpr int kSize = 32;
  const Image plate = noisyPlate(kSize, kSize);
  RenderSettings settings = smallRender(kSize, kSize, 128, 4);
  const auto layers = [&](bool adaptive, Passes passes) {
    settings.adaptive = adaptive;
    return composite(w, Probe(sunnyProbe()), "importance", settings, plate, passes);
  };
  const CompositeRender adaptive = layers(true, Passes::Two), even = layers(false, Passes::One);
  EXPECT_TRUE(adaptive.result.adaptive);
  for (const CompositeLayer layer : {CompositeLayer::WithoutObjects, CompositeLayer::WithObjects}) {
    const Image found = compositeLayer(adaptive.film(), layer);
    const Image expected = compositeLayer(even.film(), layer);
    EXPECT_NEAR(luminance(meanColor(found)) / luminance(meanColor(expected)), 1, 0.02);
  }
  // Pixel by pixel, up to the noise: no ratio of counts is in them.
  const Image without = compositeLayer(adaptive.film(), CompositeLayer::WithoutObjects);
  const Image expected = compositeLayer(even.film(), CompositeLayer::WithoutObjects);
  int floor = 0, far = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (adaptive.film().at(x, y).covered > 0 || even.film().at(x, y).local.x == 0) continue;
      ++floor;
      far += std::fabs(luminance(without.rgb(x, y)) / luminance(expected.rgb(x, y)) - 1) > 0.35f;
    }
  EXPECT_GT(floor, 300);
  EXPECT_LT(far, floor / 50);
}

// Where a pass was stopped before it reached a pixel, the composite is the plate.
TEST(Composite, TwoInterruptedPassesLeaveThePlate) {
  const Worlds w = stillLife();
  const World world(w.scene, rayMasks(w.isObject), allTables());
  const Probe probe(sunnyProbe());
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const Image plate = noisyPlate(96, 96);
  for (const double stopAt : {0.0, 0.2, 0.5, 0.51, 0.55}) {
    std::atomic<bool> stop = false;
    const CompositeRender r = renderComposite(
        world, w.camera, *lighting, plate, smallRender(96, 96, 16, 3), Passes::Two, true,
        [&](double fraction) { stop = stop || fraction >= stopAt; }, stop);
    EXPECT_TRUE(r.result.interrupted);
    for (const CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio}) {
      const Composite c = compose(r.film(), r.mean, plate, mode);
      int unsampled = 0;
      for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
          if (r.film().at(x, y).count > 0) continue;
          ++unsampled;
          EXPECT_EQ(c.color.rgb(x, y), plate.rgb(x, y));
        }
      if (stopAt < 0.5) {
        EXPECT_EQ(unsampled, 96 * 96) << stopAt;
      }
      EXPECT_EQ(unsampled > 0, r.result.samples == 0) << stopAt;
    }
  }
}

// The layers of the first surface equal those of a pass with the objects.
TEST(Composite, TwoPassesHaveTheLayersOfSurfaces) {
  const Worlds w = stillLife();
  RenderSettings settings = smallRender(16, 16, 64, 3);
  settings.aovs = {Aov::AmbientOcclusion, Aov::Irradiance};
  const auto meanOf = [&](Passes passes, Aov aov) {
    const CompositeRender r =
        composite(w, Probe(sunnyProbe()), "importance", settings, noisyPlate(16, 16), passes);
    double sum = 0;
    for (const float texel : r.result.aovs.finished(aov).texels) sum += double(texel);
    return sum;
  };
  for (const Aov aov : settings.aovs)
    EXPECT_NEAR(meanOf(Passes::Two, aov) / meanOf(Passes::One, aov), 1, 0.03);
}

// A lamp among the objects lights a glossy floor even with strategies that replace the probe by
// lights, which do not light glossy surfaces.
TEST(Composite, LampsLightGlossySurfacesWithEveryStrategy) {
  Worlds w;
  Material metal;
  metal.roughness = 0.3f;
  addQuad(w.scene, addMaterial(w.scene, metal), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.markRestLocal();
  Material lamp = lambert(Rgb(0));
  lamp.emission = {4, 3, 2};
  addQuad(w.scene, addMaterial(w.scene, lamp), {-1, 2, -2}, {2, 0, 0}, {0, 0.7f, -0.7f});
  w.markRestObjects();
  const Probe dim(constantProbe({16, 8}, Rgb(1e-5f)));
  const auto difference = [&](const char* strategy, Mis mis) {
    RenderSettings settings = smallRender(24, 16, 64, 3);
    settings.mis = mis;
    const CompositeRender r = composite(w, dim, strategy, settings, noisyPlate(24, 16));
    return luminance(meanColor(compositeLayer(r.film(), CompositeLayer::Difference)));
  };
  const float expected = difference("importance", Mis::Balance);
  EXPECT_GT(expected, 0.01f);
  for (const Mis mis : {Mis::Off, Mis::Balance})
    EXPECT_NEAR(difference("median-cut:16", mis) / expected, 1, 0.02) << int(mis);
}

// The objects are matte, because caustics are noise of L_obj alone and do not cancel.
TEST(Composite, DifferenceHasATenthOfTheVarianceOfTwoRenders) {
  Worlds w;
  // A courtyard with interreflection between its walls.
  w.camera = Camera::lookAt({0, 5, 7}, {0, 0.8f, 0}, {0, 1, 0}, 0.9f);
  const int wall = addMaterial(w.scene, lambert(Rgb(0.6f)));
  addQuad(w.scene, wall, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addQuad(w.scene, wall, {-4, 0, -4}, {8, 0, 0}, {0, 5, 0});
  addQuad(w.scene, wall, {-4, 0, 4}, {0, 0, -8}, {0, 5, 0});
  addQuad(w.scene, wall, {4, 0, 4}, {0, 5, 0}, {0, 0, -8});
  w.markRestLocal();
  addSphere(w.scene, addMaterial(w.scene, lambert({0.8f, 0.1f, 0.1f})), {-0.8f, 0.5f, 0}, 0.5f, 16);
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.6f))), {0.6f, 0.5f, -0.4f}, 0.5f, 24);
  w.markRestObjects();
  constexpr int kSize = 32, kRepeats = 8;
  double variance[2] = {};
  for (Passes passes : {Passes::One, Passes::Two}) {
    std::vector<std::vector<double>> pixels(size_t(kSize) * kSize * 3);
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const RenderSettings settings = smallRender(kSize, kSize, 16, 5, 40 + uint64_t(repeat));
      const CompositeRender r = composite(w, Probe(sunnyProbe()), "importance", settings,
                                          noisyPlate(kSize, kSize), passes);
      const Image difference = compositeLayer(r.film(), CompositeLayer::Difference);
      for (size_t i = 0; i < pixels.size(); ++i) pixels[i].push_back(difference.texels[i]);
    }
    for (const auto& repeats : pixels)
      variance[passes == Passes::Two] += Moments::of(repeats).variance;
  }
  EXPECT_LT(10 * variance[0], variance[1]);
}

// The estimated error of the composite matches the variance over seeds.
TEST(SlowComposite, EstimatedErrorMatchesTheVarianceOverSeeds) {
  Worlds w = stillLife();
  w.scene.materials[3].roughness = 1;  // caustics of the mirror would need more samples
  constexpr int kSize = 24, kRepeats = 16;
  std::vector<std::vector<double>> pixels(size_t(kSize) * kSize * 3);
  double estimated = 0, spread = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const RenderSettings settings = smallRender(kSize, kSize, 64, 5, 70 + uint64_t(repeat));
    const CompositeRender r =
        composite(w, Probe(sunnyProbe()), "importance", settings, noisyPlate(kSize, kSize));
    const Image variance = varianceImage(r.errors);
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].push_back(r.mean.texels[i]);
      estimated += variance.texels[i] / kRepeats;
    }
  }
  for (const auto& repeats : pixels) spread += Moments::of(repeats).variance;
  // The estimate is too large where few pixels receive most of the light.
  EXPECT_GT(estimated / spread, 0.9);
  EXPECT_LT(estimated / spread, 1.4);
}

// The noise estimate describes the composite that is written, also in ratio mode and with two
// passes.
TEST(SlowComposite, NoiseEstimateMatchesTheComposite) {
  Worlds w = stillLife();
  w.scene.materials[3].roughness = 1;
  constexpr int kSize = 24, kRepeats = 16;
  Image plate = noisyPlate(kSize, kSize);
  for (float& x : plate.texels) x += 0.5f;  // bright enough to stay positive
  struct Mode {
    Passes passes;
    CompositeMode mode;
  };
  for (const Mode way :
       {Mode{Passes::One, CompositeMode::Difference}, Mode{Passes::One, CompositeMode::Ratio},
        Mode{Passes::Two, CompositeMode::Difference}}) {
    std::vector<std::vector<double>> pixels(size_t(kSize) * kSize);
    std::vector<double> squared(pixels.size(), 0.0);
    double estimated = 0, spread = 0;  // sums of standard errors
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const CompositeRender r =
          composite(w, Probe(sunnyProbe()), "importance",
                    smallRender(kSize, kSize, 32, 5, 170 + uint64_t(repeat)), plate, way.passes);
      const Composite c = compose(r.film(), r.mean, plate, way.mode);
      const PixelErrors errors = compositeErrors(r.film(), c, r.errors);
      for (size_t i = 0; i < pixels.size(); ++i) {
        pixels[i].push_back(luminance(glm::dvec3(c.color.rgb(int(i) % kSize, int(i) / kSize))));
        squared[i] += errors.halves[i].w / kRepeats;
      }
    }
    for (const auto& repeats : pixels) spread += std::sqrt(Moments::of(repeats).variance);
    for (double s : squared) estimated += std::sqrt(s);
    // The estimate for the ratio neglects the variance of L_noobj.
    EXPECT_NEAR(estimated / spread, 1, way.mode == CompositeMode::Ratio ? 0.3 : 0.1)
        << int(way.passes) << int(way.mode);
  }
}

// With a render of the local scene as the plate, the composite equals a render of the whole scene.
TEST(SlowComposite, MatchesTheReferenceIfTheLocalSceneIsExact) {
  const Worlds w = stillLife();
  const Probe probe(sunnyProbe(), 25);
  constexpr int kSize = 32;
  RenderSettings settings = smallRender(kSize, kSize, 512, 5, 7);
  settings.hideProbe = true;
  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  Scene local = stillLife().scene;  // without the objects, which include the lamp
  local.instances.resize(2);
  const World localWorld(local), wholeWorld(w.scene);
  const auto quiet = [](double) {};
  const Film photograph = render(localWorld, w.camera, *lighting, settings, quiet, stop).film;
  settings.seed = 8;
  const Film reference = render(wholeWorld, w.camera, *lighting, settings, quiet, stop).film;
  const CompositeRender r =
      composite(w, probe, "importance", smallRender(kSize, kSize, 256, 5, 9), photograph.mean());
  const Image referenceMean = reference.mean(), referenceError = varianceImage(reference.errors()),
              plateError = varianceImage(photograph.errors());
  for (CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio}) {
    const Composite c = compose(r.film(), r.mean, photograph.mean(), mode);
    const Image error = varianceImage(compositeErrors(r.film(), c, r.errors));
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < referenceMean.texels.size(); ++i) {
      const double variance =
          double(error.texels[i]) + referenceError.texels[i] + plateError.texels[i];
      const double z = (c.color.texels[i] - referenceMean.texels[i]) / std::sqrt(variance);
      if (!(variance > 1e-12)) continue;
      sum += z, squares += z * z, ++n;
    }
    EXPECT_GT(n, 2000);
    EXPECT_NEAR(sum / n, 0, 0.1) << int(mode);
    EXPECT_LT(std::sqrt(squares / n), 1.1) << int(mode);
    // Below 1 because errors near the mirror's caustics are overestimated.
    EXPECT_GT(std::sqrt(squares / n), 0.4) << int(mode);
  }
}

LayerFilm onePixel(const DifferentialPixel& pixel) {
  LayerFilm film(2, 1, DifferentialFilm::layers());
  const auto add = [&](int x, const DifferentialPixel& p) {
    const std::vector<Rgb> none(DifferentialFilm::kLayers, Rgb(0));
    film.add(x, 0, 0,
             std::vector<Rgb>{Rgb(float(p.covered)), Rgb(p.objects), Rgb(p.behind), Rgb(p.local),
                              Rgb(p.difference)});
    for (int i = 1; i < int(p.count); ++i) film.add(x, 0, 0, none);
  };
  add(0, pixel);
  add(1, {1, 0, {}, {}, glm::dvec3(1), {}});  // and one of L_noobj = 1
  return film;
}

// Difference: alpha L_obj + (1 - alpha) (plate + L_obj - L_noobj).
// Ratio: alpha L_obj + (1 - alpha) plate L_obj / L_noobj.
TEST(Composite, MatchesTheFormulas) {
  // Four samples: one hits the object, with L_obj = (2, 4, 6); three have L_noobj = 0.5, L_obj =
  // 0.2.
  const LayerFilm layers =
      onePixel({4, 1, {2, 4, 6}, {}, glm::dvec3(1.5), glm::dvec3(3 * (0.2 - 0.5))});
  const DifferentialFilm film(layers);
  Image plate(2, 1, 3);
  plate.setRgb(0, 0, {0.6f, 1, 0.4f});
  const Image mean = [&] {
    Image image(2, 1, 3);
    image.setRgb(0, 0, 0.25f * Rgb(2, 4, 6) + 0.75f * (plate.rgb(0, 0) - 0.3f));
    return image;
  }();
  const Rgb difference = compose(film, mean, plate, CompositeMode::Difference).color.rgb(0, 0);
  EXPECT_EQ(difference, mean.rgb(0, 0));
  const Rgb ratio = compose(film, mean, plate, CompositeMode::Ratio).color.rgb(0, 0);
  const Rgb expected = 0.25f * Rgb(2, 4, 6) + 0.75f * plate.rgb(0, 0) * 0.4f;
  EXPECT_LT(glm::length(ratio - expected), 1e-6f);
  EXPECT_EQ(*compositeLayer(film, CompositeLayer::Alpha).at(0, 0), 0.25f);
}

// Ratio mode blends continuously from the difference, for L_noobj below 1/1000 of the image's mean,
// to the ratio, above 2/1000.
TEST(Composite, RatioFallsBackToTheDifferenceInTheDark) {
  Image plate(2, 1, 3);
  plate.setRgb(0, 0, Rgb(0.02f));
  double before = -1;
  for (double local : {0.0, 1e-7, 1e-4, 4.99e-4, 5.01e-4, 7e-4, 9.99e-4, 1.001e-3, 0.01}) {
    // The mean of both pixels is near 0.5, so the thresholds are near 5e-4 and 1e-3.
    const double added = 0.001;
    const LayerFilm layers = onePixel({1, 0, {}, {}, glm::dvec3(local), glm::dvec3(added)});
    const DifferentialFilm film(layers);
    const double found =
        compose(film, Image(2, 1, 3), plate, CompositeMode::Ratio).color.rgb(0, 0).y;
    ASSERT_TRUE(std::isfinite(found));
    if (local < 4.999e-4) {
      EXPECT_NEAR(found, 0.02 + added, 1e-8) << local;
    }
    if (local > 1.0005e-3) {
      EXPECT_NEAR(found, 0.02 * (1 + added / local), 1e-7) << local;
    }
    if (local > 4.999e-4 && local < 5.1e-4) {
      EXPECT_NEAR(found, before, 1e-3) << local;
    }
    if (local > 1.0005e-3 && local < 1.1e-3) {
      EXPECT_NEAR(found, before, 1e-3) << local;
    }
    before = found;
  }
}

// plate + L_obj - L_noobj may be negative; it is clamped to 0 and counted.
TEST(Composite, NegativeValuesAreClamped) {
  const LayerFilm layers = onePixel({1, 0, {}, {}, glm::dvec3(1), glm::dvec3(-0.5)});
  const DifferentialFilm film(layers);
  Image plate(2, 1, 3), mean(2, 1, 3);
  plate.setRgb(0, 0, {0.3f, 0.6f, 0.7f});
  mean.setRgb(0, 0, {-0.2f, 0.1f, 0.2f});
  const Composite c = compose(film, mean, plate, CompositeMode::Difference);
  EXPECT_EQ(c.color.rgb(0, 0), Rgb(0, 0.1f, 0.2f));
  EXPECT_EQ(c.darkerThanBlack, 1u);
}

// A transparent quad covers a pixel by its alpha, an edge by its fraction of the pixel's area.
TEST(Composite, AlphaIsFractional) {
  Worlds w;
  w.camera = topCamera(4, 53.1301f);  // sees 4 x 4 metres of the ground
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.markRestLocal();
  Material veil = lambert(Rgb(0));
  veil.alphaMode = AlphaMode::Blend;
  veil.baseColor.w = 0.3f;
  addQuad(w.scene, addMaterial(w.scene, veil), {-3, 1e-3f, 3}, {3.5f, 0, 0}, {0, 0, -6});
  w.markRestObjects();
  const CompositeRender r = composite(w, Probe(constantProbe({8, 4}, Rgb(1))), "importance",
                                      smallRender(4, 4, 1024, 1), Image(4, 4, 3));
  const Image alpha = compositeLayer(r.film(), CompositeLayer::Alpha);
  const float expected[4] = {0.3f, 0.3f, 0.15f, 0};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(*alpha.at(x, y), expected[x], 0.06f) << x;
}

}  // namespace
}  // namespace chromeball::composite_test

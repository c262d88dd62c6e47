// SPDX-License-Identifier: Apache-2.0
// Differential rendering: what the objects change, and to the last bit nothing else.
#include "composite/compose.h"

#include <gtest/gtest.h>

#include "composite/layers.h"
#include "composite/render_composite.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {
namespace {

// A scene in which some instances are objects.
struct Worlds {
  Scene scene;
  ObjectMask isObject;
  Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.4f, 0}, {0, 1, 0}, 0.7f);

  void isLocalSoFar() { isObject.resize(scene.instances.size(), false); }
  void areObjectsFromHere() { isObject.resize(scene.instances.size(), true); }
};

CompositeRender composite(const Worlds& w, const Probe& probe, const std::string& strategy,
                          const RenderSettings& settings, const Image& plate,
                          Passes passes = Passes::One) {
  const World world(w.scene, rayMasks(w.isObject));
  const auto lighting = makeStrategy(strategy, probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  return renderComposite(
      world, w.camera, *lighting, plate, settings, passes, true, [](double) {}, stop);
}

// Numbers that no arithmetic leaves alone by accident.
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

// A red ball, a mirror, a veil and a lamp over a grey ground with a wall.
Worlds stillLife() {
  Worlds w;
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  Material wall;
  wall.baseColor = {0.6f, 0.6f, 0.7f, 1};
  wall.metallic = 0;
  wall.roughness = 0.4f;
  addQuad(w.scene, addMaterial(w.scene, wall), {-3, 0, -1.5f}, {6, 0, 0}, {0, 2, 0});
  w.isLocalSoFar();
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
  w.areObjectsFromHere();
  return w;
}

constexpr const char* kStrategies[] = {"bsdf",          "uniform",
                                       "importance",    "suns",
                                       "median-cut:16", "kollig-keller-strata:4",
                                       "penrose:32",    "irradiance-fit-ambient:4"};

// Objects that nobody sees, buried under the ground: the plate, to the last bit.
TEST(Composite, IsThePlateWhereObjectsChangeNothing) {
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
  w.isLocalSoFar();
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.9f))), {0, -2, 0}, 1, 16);
  w.areObjectsFromHere();

  const Image plate = noisyPlate(24, 16);
  for (const char* strategy : kStrategies) {
    const CompositeRender r =
        composite(w, Probe(sunnyProbe(), 25), strategy, smallRender(24, 16, 13, 6), plate);
    EXPECT_EQ(r.mean.texels, plate.texels) << strategy;
    for (CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio})
      EXPECT_EQ(compose(r.film, r.mean, plate, mode).color.texels, plate.texels) << strategy;
    EXPECT_GT(luminance(meanColor(compositeLayer(r.film, CompositeLayer::WithoutObjects))), 0.1f);
  }
}

// A local wall that hides its back from the camera stands before an object: the object is seen in
// both ways of rendering, and the wall in neither.
TEST(Composite, SeesObjectsThroughHiddenBacks) {
  Worlds w;
  w.camera = Camera::lookAt({0, 1, 4}, {0, 1, 0}, {0, 1, 0}, 0.5f);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  Material wall = lambert(Rgb(0.5f));
  wall.doubleSided = false;
  addQuad(w.scene, addMaterial(w.scene, wall), {3, 0, 2}, {-6, 0, 0}, {0, 3, 0});
  w.isLocalSoFar();
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {0, 1, 0}, 0.5f, 24);
  w.areObjectsFromHere();
  const Probe probe(sunnyProbe());
  const Image plate = noisyPlate(16, 16);
  std::vector<Image> alphas;
  for (const Passes passes : {Passes::One, Passes::Two})
    alphas.push_back(compositeLayer(
        composite(w, probe, "importance", smallRender(16, 16, 16, 3), plate, passes).film,
        CompositeLayer::Alpha));
  EXPECT_EQ(*alphas[0].at(8, 8), 1);
  EXPECT_EQ(alphas[0].texels, alphas[1].texels);
}

// Every sample of a lamp is beyond floats: a defect of its own kind, in one pass and in two.
TEST(Composite, InvalidSamplesAreCountedByCause) {
  Worlds w;
  w.camera = topCamera(6, 40);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.isLocalSoFar();
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(INFINITY);
  addSphere(w.scene, addMaterial(w.scene, lamp), {0, 1, 0}, 0.5f, 16);
  w.areObjectsFromHere();
  for (const Passes passes : {Passes::One, Passes::Two}) {
    const CompositeRender r = composite(w, Probe(sunnyProbe()), "bsdf", smallRender(16, 16, 4, 0),
                                        noisyPlate(16, 16), passes);
    EXPECT_GT(r.result.invalid.of(Defect::Infinite), 0u);
    EXPECT_EQ(r.result.invalid.of(Defect::Nan), 0u);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        EXPECT_TRUE(std::isfinite(r.film.at(x, y).objects.x + r.film.at(x, y).difference.x));
  }
}

// A wall higher than the object keeps its light and its shadow on one side; there they show.
TEST(Composite, ChangesNothingBehindAWall) {
  Worlds w;
  w.camera = topCamera(6, 40);
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {0, 0, 3}, {0, 0, -6}, {0, 1, 0});
  w.isLocalSoFar();
  addSphere(w.scene, addMaterial(w.scene, lambert({0.9f, 0.1f, 0.1f})), {1, 0.4f, 0}, 0.4f, 16);
  w.areObjectsFromHere();
  const Image plate = noisyPlate(32, 32);
  const CompositeRender r =
      composite(w, Probe(sunnyProbe()), "importance", smallRender(32, 32, 32, 6), plate);
  const Image difference = compositeLayer(r.film, CompositeLayer::Difference);
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

// L_obj and L_noobj are what plain renders with the same random numbers make of the two scenes.
TEST(Composite, BothWorldsArePlainRenders) {
  Worlds w = stillLife();
  w.scene.materials.back().emission = Rgb(0);  // without a table of lamps both are the same
  const Probe probe(sunnyProbe(), 25);
  RenderSettings settings = smallRender(32, 24, 16, 6);
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
    const Image ours = compositeLayer(r.film, aov);
    for (size_t i = 0; i < plain.texels.size(); ++i)
      ASSERT_NEAR(ours.texels[i], plain.texels[i], 1e-5f * (1 + plain.texels[i]))
          << int(aov) << " " << i;
  }
}

// [tile and channel][repeat]
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

// One pass along shared paths against two renders subtracted: the same, and far less noisy.
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

// A lamp that is put in shows in a floor too smooth for lights in the probe's place.
TEST(Composite, LampsShineOnNearMirrorsWhateverTheStrategy) {
  Worlds w;
  Material metal;
  metal.roughness = 0.3f;
  addQuad(w.scene, addMaterial(w.scene, metal), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.isLocalSoFar();
  Material lamp = lambert(Rgb(0));
  lamp.emission = {4, 3, 2};
  addQuad(w.scene, addMaterial(w.scene, lamp), {-1, 2, -2}, {2, 0, 0}, {0, 0.7f, -0.7f});
  w.areObjectsFromHere();
  const Probe dim(constantProbe({16, 8}, Rgb(1e-5f)));
  const auto difference = [&](const char* strategy, Mis mis) {
    RenderSettings settings = smallRender(24, 16, 64, 3);
    settings.mis = mis;
    const CompositeRender r = composite(w, dim, strategy, settings, noisyPlate(24, 16));
    return luminance(meanColor(compositeLayer(r.film, CompositeLayer::Difference)));
  };
  const float expected = difference("importance", Mis::Balance);
  EXPECT_GT(expected, 0.01f);
  for (const Mis mis : {Mis::Off, Mis::Balance})
    EXPECT_NEAR(difference("median-cut:16", mis) / expected, 1, 0.02) << int(mis);
}

// Light that objects focus (caustics) is noise of L_obj alone, which nothing can cancel: matte
// ones.
TEST(Composite, DifferenceHasATenthOfTheVarianceOfTwoRenders) {
  Worlds w;
  // A courtyard, whose walls light each other.
  w.camera = Camera::lookAt({0, 5, 7}, {0, 0.8f, 0}, {0, 1, 0}, 0.9f);
  const int wall = addMaterial(w.scene, lambert(Rgb(0.6f)));
  addQuad(w.scene, wall, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addQuad(w.scene, wall, {-4, 0, -4}, {8, 0, 0}, {0, 5, 0});
  addQuad(w.scene, wall, {-4, 0, 4}, {0, 0, -8}, {0, 5, 0});
  addQuad(w.scene, wall, {4, 0, 4}, {0, 5, 0}, {0, 0, -8});
  w.isLocalSoFar();
  addSphere(w.scene, addMaterial(w.scene, lambert({0.8f, 0.1f, 0.1f})), {-0.8f, 0.5f, 0}, 0.5f, 16);
  addSphere(w.scene, addMaterial(w.scene, lambert(Rgb(0.6f))), {0.6f, 0.5f, -0.4f}, 0.5f, 24);
  w.areObjectsFromHere();
  constexpr int kSize = 32, kRepeats = 8;
  double variance[2] = {};
  for (Passes passes : {Passes::One, Passes::Two}) {
    std::vector<std::vector<double>> pixels(size_t(kSize) * kSize * 3);
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const RenderSettings settings = smallRender(kSize, kSize, 16, 5, 40 + uint64_t(repeat));
      const CompositeRender r = composite(w, Probe(sunnyProbe()), "importance", settings,
                                          noisyPlate(kSize, kSize), passes);
      const Image difference = compositeLayer(r.film, CompositeLayer::Difference);
      for (size_t i = 0; i < pixels.size(); ++i) pixels[i].push_back(difference.texels[i]);
    }
    for (const auto& repeats : pixels)
      variance[passes == Passes::Two] += Moments::of(repeats).variance;
  }
  EXPECT_LT(10 * variance[0], variance[1]);
}

// The error that is stated for the composite is the spread over seeds.
TEST(Composite, StatesItsError) {
  Worlds w = stillLife();
  w.scene.materials[3].roughness = 1;  // the mirror's caustics would take more samples to state
  constexpr int kSize = 24, kRepeats = 16;
  std::vector<std::vector<double>> pixels(size_t(kSize) * kSize * 3);
  double stated = 0, spread = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const RenderSettings settings = smallRender(kSize, kSize, 64, 5, 70 + uint64_t(repeat));
    const CompositeRender r =
        composite(w, Probe(sunnyProbe()), "importance", settings, noisyPlate(kSize, kSize));
    const Image variance = varianceImage(r.errors);
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].push_back(r.mean.texels[i]);
      stated += variance.texels[i] / kRepeats;
    }
  }
  for (const auto& repeats : pixels) spread += Moments::of(repeats).variance;
  // The layer is wide where few pixels meet most of the light.
  EXPECT_GT(stated / spread, 0.9);
  EXPECT_LT(stated / spread, 1.4);
}

// What is said of the noise is of the picture that is written: by the ratio, and of two passes.
TEST(SlowComposite, NoiseIsOfThePictureThatIsWritten) {
  Worlds w = stillLife();
  w.scene.materials[3].roughness = 1;
  constexpr int kSize = 24, kRepeats = 16;
  Image plate = noisyPlate(kSize, kSize);
  for (float& x : plate.texels) x += 0.5f;  // bright enough to stay positive
  struct Way {
    Passes passes;
    CompositeMode mode;
  };
  for (const Way way :
       {Way{Passes::One, CompositeMode::Difference}, Way{Passes::One, CompositeMode::Ratio},
        Way{Passes::Two, CompositeMode::Difference}}) {
    std::vector<std::vector<double>> pixels(size_t(kSize) * kSize);
    std::vector<double> squared(pixels.size(), 0.0);
    double stated = 0, spread = 0;  // sums of standard errors
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const CompositeRender r =
          composite(w, Probe(sunnyProbe()), "importance",
                    smallRender(kSize, kSize, 32, 5, 170 + uint64_t(repeat)), plate, way.passes);
      const Composite c = compose(r.film, r.mean, plate, way.mode);
      const PixelErrors errors = compositeErrors(r.film, c, r.errors);
      for (size_t i = 0; i < pixels.size(); ++i) {
        pixels[i].push_back(luminance(glm::dvec3(c.color.rgb(int(i) % kSize, int(i) / kSize))));
        squared[i] += errors.halves[i].w / kRepeats;
      }
    }
    for (const auto& repeats : pixels) spread += std::sqrt(Moments::of(repeats).variance);
    for (double s : squared) stated += std::sqrt(s);
    // The ratio's estimate takes L_noobj for known.
    EXPECT_NEAR(stated / spread, 1, way.mode == CompositeMode::Ratio ? 0.3 : 0.1)
        << int(way.passes) << int(way.mode);
  }
}

// A photograph of the local scene, with objects put in, is the picture of the whole scene.
TEST(SlowComposite, MatchesTheTruthWhereTheLocalSceneIsExact) {
  const Worlds w = stillLife();
  const Probe probe(sunnyProbe(), 25);
  constexpr int kSize = 32;
  RenderSettings settings = smallRender(kSize, kSize, 512, 5, 7);
  settings.hideProbe = true;
  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  Scene local = stillLife().scene;  // without the objects, and their lamps
  local.instances.resize(2);
  const World localWorld(local), wholeWorld(w.scene);
  const auto quiet = [](double) {};
  const Film photograph = render(localWorld, w.camera, *lighting, settings, quiet, stop).film;
  settings.seed = 8;
  const Film truth = render(wholeWorld, w.camera, *lighting, settings, quiet, stop).film;
  const CompositeRender r =
      composite(w, probe, "importance", smallRender(kSize, kSize, 256, 5, 9), photograph.mean());
  const Image truthMean = truth.mean(), truthError = varianceImage(truth.errors()),
              plateError = varianceImage(photograph.errors());
  for (CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio}) {
    const Composite c = compose(r.film, r.mean, photograph.mean(), mode);
    const Image error = varianceImage(compositeErrors(r.film, c, r.errors));
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < truthMean.texels.size(); ++i) {
      const double variance = double(error.texels[i]) + truthError.texels[i] + plateError.texels[i];
      const double z = (c.color.texels[i] - truthMean.texels[i]) / std::sqrt(variance);
      if (!(variance > 1e-12)) continue;
      sum += z, squares += z * z, ++n;
    }
    EXPECT_GT(n, 2000);
    EXPECT_NEAR(sum / n, 0, 0.1) << int(mode);
    EXPECT_LT(std::sqrt(squares / n), 1.1) << int(mode);
    EXPECT_GT(std::sqrt(squares / n), 0.4) << int(mode);  // wide around the mirror's caustics
  }
}

DifferentialFilm onePixel(const DifferentialPixel& pixel) {
  LayerFilm film(2, 1, DifferentialFilm::layers());
  const auto add = [&](int x, const DifferentialPixel& p) {
    const std::vector<Rgb> none(DifferentialFilm::kLayers, Rgb(0));
    film.add(x, 0,
             std::vector<Rgb>{Rgb(float(p.covered)), Rgb(p.objects), Rgb(p.behind), Rgb(p.local),
                              Rgb(p.difference)});
    for (int i = 1; i < int(p.count); ++i) film.add(x, 0, none);
  };
  add(0, pixel);
  add(1, {1, 0, {}, {}, glm::dvec3(1), {}});  // and one of L_noobj = 1
  return DifferentialFilm(std::move(film));
}

// alpha L_obj + (1 - alpha) (plate + L_obj - L_noobj), or the plate times L_obj / L_noobj.
TEST(Composite, FollowsTheFormulas) {
  // Four samples: one on the object (2, 4, 6); three that see 0.5 without and 0.2 with objects.
  const DifferentialFilm film =
      onePixel({4, 1, {2, 4, 6}, {}, glm::dvec3(1.5), glm::dvec3(3 * (0.2 - 0.5))});
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

// Below a thousandth of the picture's mean L_noobj the ratio is the difference; from twice that on
// it is the ratio, and between the two it has no jump.
TEST(Composite, RatioGivesWayToTheDifferenceInTheDark) {
  Image plate(2, 1, 3);
  plate.setRgb(0, 0, Rgb(0.02f));
  double before = -1;
  for (double local : {0.0, 1e-7, 1e-4, 4.99e-4, 5.01e-4, 7e-4, 9.99e-4, 1.001e-3, 0.01}) {
    // The mean of both pixels is near 0.5, so the thresholds are near 5e-4 and 1e-3.
    const double added = 0.001;
    const DifferentialFilm film = onePixel({1, 0, {}, {}, glm::dvec3(local), glm::dvec3(added)});
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

// The difference may ask for more than the plate has.
TEST(Composite, IsNeverDarkerThanBlack) {
  const DifferentialFilm film = onePixel({1, 0, {}, {}, glm::dvec3(1), glm::dvec3(-0.5)});
  Image plate(2, 1, 3), mean(2, 1, 3);
  plate.setRgb(0, 0, {0.3f, 0.6f, 0.7f});
  mean.setRgb(0, 0, {-0.2f, 0.1f, 0.2f});
  const Composite c = compose(film, mean, plate, CompositeMode::Difference);
  EXPECT_EQ(c.color.rgb(0, 0), Rgb(0, 0.1f, 0.2f));
  EXPECT_EQ(c.darkerThanBlack, 1u);
}

// Coverage by a veil is its alpha; by an edge, its share of the pixel.
TEST(Composite, AlphaIsFractional) {
  Worlds w;
  w.camera = topCamera(4, 53.1301f);  // sees 4 x 4 metres of the ground
  addQuad(w.scene, addMaterial(w.scene, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  w.isLocalSoFar();
  Material veil = lambert(Rgb(0));
  veil.alphaMode = AlphaMode::Blend;
  veil.baseColor.w = 0.3f;
  addQuad(w.scene, addMaterial(w.scene, veil), {-3, 1e-3f, 3}, {3.5f, 0, 0}, {0, 0, -6});
  w.areObjectsFromHere();
  const CompositeRender r = composite(w, Probe(constantProbe({8, 4}, Rgb(1))), "importance",
                                      smallRender(4, 4, 1024, 1), Image(4, 4, 3));
  const Image alpha = compositeLayer(r.film, CompositeLayer::Alpha);
  const float expected[4] = {0.3f, 0.3f, 0.15f, 0};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(*alpha.at(x, y), expected[x], 0.06f) << x;
}

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Light stages: one pass of path tracing gives a scene under every lighting condition, whose
// weighted sum is the scene under a probe.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "hypothesis.h"
#include "math/vec.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "relight/stage/direction_basis.h"
#include "relight/stage/light_stage.h"
#include "relight/stage/relit_stage.h"
#include "small_scenes.h"
#include "sphere_test.h"
#include "temporary_folder.h"
#include "whole_stage.h"

namespace chromeball::light_stage_test {
namespace {

constexpr const char* kBases[] = {"lat-long:16x8", "cube:4", "icosphere:1", "sh:3"};

RenderSettings settingsOf(uint32_t samples, uint64_t seed = 0) {
  RenderSettings s = smallRender(32, 24, samples, 4, seed);
  s.guiding = Guiding::Off;
  return s;
}

Camera cameraOf() { return Camera::lookAt({0, 2, 4}, {0, 0.4f, 0}, {0, 1, 0}, 0.6f); }

BasisRender stageOf(const Scene& scene, const char* basis, const RenderSettings& settings) {
  const World world(scene, {}, allTables());
  return renderBasis(world, cameraOf(), basis, settings);
}

Image relit(const LightStage& stage, const std::vector<Rgb>& weights) {
  Image sum = weightedSum(stage.elements, weights);
  addOwnLight(sum, stage.own);
  return sum;
}

// The largest difference as a fraction of the whole picture's mean.
double largestDifference(const Image& a, const Image& b) {
  double most = 0, sum = 0;
  for (size_t i = 0; i < a.texels.size(); ++i) {
    most = std::max(most, std::fabs(double(a.texels[i]) - double(b.texels[i])));
    sum += std::fabs(double(b.texels[i]));
  }
  return most / (sum / double(a.texels.size()));
}

std::vector<Rgb> randomWeights(int count, int seed) {
  std::vector<Rgb> weights;
  for (int i = 0; i < count; ++i)
    weights.emplace_back(random2(i, seed).x, random2(i, seed).y, random2(i, seed + 2).x);
  return weights;
}

// Light of any radiance, which the strategy `uniform` samples.
template <class Radiance>
class UniformLight : public LightSource {
 public:
  explicit UniformLight(Radiance radiance) : radiance_(radiance) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const vec3 wi =
        Frame(point.normal).toWorld(squareToUniformHemisphere(sampler.get2(dimension::kLight)));
    out.push_back({wi, radiance_(wi) * (2 * kPi), 0.5f * kInvPi});
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return {radiance_(wi), glm::dot(point.normal, wi) > 0 ? 0.5f * kInvPi : 0};
  }
  Rgb background(const vec3&, const vec3& wi) const override { return radiance_(wi); }

 private:
  Radiance radiance_;
};

Image renderUnder(const Scene& scene, const LightSource& lighting, const RenderSettings& settings) {
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  return render(
             world, cameraOf(), lighting, settings, [](double) {}, stop)
      .film.mean();
}

TEST(DirectionBasis, ParsesNames) {
  const auto size = [](const char* name) { return DirectionBasis(name, "test").size(); };
  EXPECT_EQ(size("lat-long:32x16"), 512);
  EXPECT_EQ(size("cube:16"), 1536);
  EXPECT_EQ(size("icosphere:2"), 320);
  EXPECT_EQ(size("sh:2"), 9);
  EXPECT_EQ(size("sh:0"), 1);
  for (const char* name :
       {"", "lat-long", "lat-long:", "lat-long:32", "lat-long:0x8", "lat-long:-4x8",
        "lat-long:99999x99999", "lat-long:4x4x4", "cube:0", "cube:37", "cube:4x4", "cube:a",
        "icosphere:5", "sh:-1", "sh:17", "sh:2 ", "disc:3", "cube:99999999999999999999"})
    EXPECT_THROW(DirectionBasis(name, "test"), InputError) << name;
}

// The cells are a partition, and each contains its function's directions.
TEST(SlowDirectionBasis, CellsHaveTheirSolidAngles) {
  const DirectionBasis boxes("lat-long:32x16", "test"), cube("cube:8", "test"),
      faces("icosphere:0", "test");
  const std::vector<double> ofBoxes = cellSolidAngles(boxes), ofCube = cellSolidAngles(cube);
  for (int i = 0; i < boxes.size(); ++i)
    ASSERT_NEAR(ofBoxes[size_t(i)] / texelSolidAngle(i / 32, 32, 16), 1, 1e-12) << i;
  const TexelSolidAngles limits = texelSolidAngles(Mapping::HorizontalStrip, {48, 8});
  EXPECT_NEAR(*std::ranges::min_element(ofCube) / limits.min, 1, 3e-3);
  EXPECT_NEAR(*std::ranges::max_element(ofCube) / limits.max, 1, 3e-3);
  for (const double solidAngle : cellSolidAngles(faces))
    EXPECT_NEAR(solidAngle / (4 * kPiD / 20), 1, 1e-3);
  // The Voronoi cells of the faces' normals are the faces themselves.
  std::vector<vec3> normals(20, vec3(0));
  for (int i = 0; i < 20000; ++i) {
    const vec3 d = squareToUniformSphere(random2(i, 0));
    normals[size_t(faces.cell(d))] += d;
  }
  for (vec3& normal : normals) normal = glm::normalize(normal);
  const DirectionBasis nearest(normals);
  int equal = 0;
  for (int i = 0; i < 10000; ++i) {
    const vec3 d = squareToUniformSphere(random2(i, 5));
    equal += nearest.cell(d) == faces.cell(d);
  }
  EXPECT_GT(equal, 9800);  // the means of random directions are not quite the normals
}

TEST(ShBasis, IsOrthonormalAndBeginsWithTheNine) {
  constexpr int kOrder = 6, kCount = shCount(kOrder);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 d(squareToUniformSphere(random2(i, 0)));
    std::array<double, kCount> all{};
    shBasis(d, kOrder, all);
    const std::array<double, kShCount> nine = shBasis(d);
    for (size_t k = 0; k < nine.size(); ++k) ASSERT_NEAR(all[k], nine[k], 1e-6) << k;
  }
  const auto products = sumOverSphere<double>(
      {512, 256}, size_t(kCount * kCount), [&](const dvec3& d, double solidAngle, auto& sums) {
        std::array<double, kCount> y{};
        shBasis(d, kOrder, y);
        for (size_t i = 0; i < kCount * kCount; ++i)
          sums[i] += y[i / kCount] * y[i % kCount] * solidAngle;
      });
  for (size_t i = 0; i < products.size(); ++i)
    EXPECT_NEAR(products[i], i / kCount == i % kCount ? 1 : 0, 2e-4) << i;
}

TEST(SlowLightWeights, AreMeansOfCellsAndIntegralsOfHarmonics) {
  const Image gradient = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.3, 0.5, -0.4});
  for (const char* name : {"lat-long:16x8", "cube:4", "icosphere:1"}) {
    const DirectionBasis basis(name, "test");
    const std::vector<Rgb> weights = lightWeights(basis, gradient, {});
    const std::vector<double> solidAngles = cellSolidAngles(basis);
    double power = 0;
    for (size_t i = 0; i < weights.size(); ++i) power += double(weights[i].y) * solidAngles[i];
    EXPECT_NEAR(power / (4 * kPiD * meanRadiance(gradient).y), 1, 1e-4) << name;
  }
  const std::vector<Rgb> sh = lightWeights({"sh:2", "test"}, gradient, {});
  const ShCoefficients projected = projectSh(gradient);
  for (size_t i = 0; i < sh.size(); ++i)
    EXPECT_NEAR(sh[i].z, projected[i].z, 0.01 * projected[0].z) << i;
}

// A turn of the probe by whole cells is a shift of the weights.
TEST(SlowLightWeights, RotationCommutesWithAShiftOfTheCells) {
  Image map(64, 32, 3);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) map.setRgb(x, y, Rgb(random2(64 * y + x, 3).x, 0.2f, 1));
  const DirectionBasis boxes("lat-long:16x8", "test"), cube("cube:4", "test");
  const std::vector<Rgb> still = lightWeights(boxes, map, {});
  const std::vector<Rgb> turned = lightWeights(boxes, map, Rotation(3 * 360.f / 16));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      const int from = (x + 3) % 16;  // counter-clockwise from above: to the left
      ASSERT_NEAR(turned[size_t(16 * y + x)].x, still[size_t(16 * y + from)].x, 1e-5);
    }
  // A tilt by a right angle turns a cube into itself: the cells are permuted.
  const auto sorted = [](std::vector<Rgb> weights) {
    std::ranges::sort(weights, {}, [](const Rgb& w) { return w.x; });
    return weights;
  };
  const auto before = sorted(lightWeights(cube, map, {}));
  const auto after = sorted(lightWeights(cube, map, Rotation::ofAngles({90, 90, 180})));
  for (size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(before[i].x, after[i].x, 2e-3);
}

TEST(SlowLightStage, UnderAConstantProbeIsTheRender) {
  for (const NamedScene& named : threeScenes()) {
    SCOPED_TRACE(named.name);
    const RenderSettings settings = settingsOf(16);
    const Image direct =
        renderScene(named.scene, cameraOf(), Probe(constantProbe({16, 8}, Rgb(0.5f, 1, 2))),
                    "uniform", settings)
            .film.mean();
    for (const char* name : kBases) {
      SCOPED_TRACE(name);
      const BasisRender render = stageOf(named.scene, name, settings);
      const auto weights =
          lightWeights(render.stage.basis, constantProbe({16, 8}, Rgb(0.5f, 1, 2)), {});
      // The quadrature of the harmonics is not exact.
      const double tolerance = render.stage.basis.hasCells() ? 1e-5 : 1e-4;
      EXPECT_LT(largestDifference(relit(render.stage, weights), direct), 20 * tolerance);
      EXPECT_LT(relativeDifference(relit(render.stage, weights), direct), tolerance);
    }
  }
}

// Not only their sum, but every element is right: the same samples, so the same picture.
TEST(LightStage, UnderLightThatIsConstantOnTheCellsIsTheRender) {
  for (const NamedScene& named : threeScenes())
    for (const char* name : kBases) {
      SCOPED_TRACE(std::string(named.name) + ", " + name);
      const DirectionBasis basis(name, "test");
      const std::vector<Rgb> weights = randomWeights(basis.size(), 7);
      const auto radiance = [&](const vec3& wi) {
        Rgb sum(0);
        basis.forValues(wi, [&](int i, float value) { sum += value * weights[size_t(i)]; });
        return sum + Rgb(10);  // harmonics alone would be negative
      };
      const Image direct = renderUnder(named.scene, UniformLight(radiance), settingsOf(8));
      const BasisRender render = stageOf(named.scene, name, settingsOf(8));
      Image sum = relit(render.stage, weights);
      for (size_t i = 0; i < sum.texels.size(); ++i) {
        const float own = render.stage.own.empty() ? 0 : render.stage.own.texels[i];
        sum.texels[i] += 10 * (render.color.texels[i] - own);
      }
      EXPECT_LT(relativeDifference(sum, direct), 1e-5);
    }
}

// The same from a probe's file, with other samples: by Welch's t-tests of all tiles.
TEST(SlowLightStage, AgreesWithImportanceSamplingOfAProbeThatIsConstantOnTheCells) {
  constexpr int kRepeats = 8;
  const DirectionBasis basis("lat-long:8x4", "test");
  const std::vector<Rgb> weights = randomWeights(basis.size(), 11);
  Image map(1024, 512, 3);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      map.setRgb(x, y, weights[size_t(basis.cell(vec3(texelDirection({1024, 512}, x, y))))]);
  // The probe's interpolation blurs the edges of the cells by a texel. Where the camera sees the
  // probe, no noise would hide that from the tests.
  const auto hidden = [](uint64_t seed) {
    RenderSettings settings = settingsOf(32, seed);
    settings.hideProbe = true;
    return settings;
  };
  const std::vector<Rgb> blurred = lightWeights(basis, map, {});
  for (size_t i = 0; i < weights.size(); ++i)
    EXPECT_NEAR(blurred[i].x, weights[i].x, 1.0 / 128) << i;
  for (const NamedScene& named : threeScenes()) {
    SCOPED_TRACE(named.name);
    std::vector<Image> staged, direct;
    for (int i = 0; i < kRepeats; ++i) {
      const BasisRender render = stageOf(named.scene, "lat-long:8x4", hidden(uint64_t(i)));
      staged.push_back(relit(render.stage, weights));
      direct.push_back(
          renderScene(named.scene, cameraOf(), Probe(map), "importance", hidden(uint64_t(100 + i)))
              .film.mean());
    }
    const Agreement result = agreement(staged, direct);
    EXPECT_GT(result.pValue, sidak(1e-3, 3)) << result.fraction;
    // The test sees an error of a few per cent.
    for (Image& image : staged)
      for (float& texel : image.texels) texel *= 1.05f;
    EXPECT_LT(agreement(staged, direct).pValue, 1e-3);
  }
}

TEST(Relight, AllDomainsGiveTheSameSum) {
  const Scene scene = threeScenes()[1].scene;
  using Case = std::pair<const char*, const char*>;
  for (const auto& [basis, domain] : {Case("lat-long:16x8", "dct"), Case("cube:4", "haar")}) {
    const LightStage stage = stageOf(scene, basis, settingsOf(8)).stage;
    const std::vector<Rgb> weights = randomWeights(stage.basis.size(), 3);
    const Image pixel = weightedSum(stage.elements, weights);
    const RelightDomain chosen = parseDomain(domain, stage.basis);
    StageBands whole(stage);
    const Image picture = relitStage(whole, weights, chosen, {}).picture;
    EXPECT_LT(relativeDifference(picture, pixel), 1e-5) << domain;
    EXPECT_LT(largestDifference(picture, pixel), 1e-4) << domain;
    EXPECT_NE(picture.texels, pixel.texels) << domain;  // the sum was made elsewhere
    // The transforms are orthonormal.
    const auto energy = [](const std::vector<Rgb>& values) {
      double sum = 0;
      for (const Rgb& value : values) sum += double(glm::dot(value, value));
      return sum;
    };
    std::vector<Rgb> transformed = weights;
    transform(transformed, stage.basis, chosen);
    EXPECT_NEAR(energy(transformed) / energy(weights), 1, 1e-5) << domain;
  }
}

TEST(Relight, KeepsTheLargest) {
  std::vector<float> values(1000);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = (i % 2 ? 1.0f : -1.0f) * float((i * 377) % 1000);
  EXPECT_NEAR(keepLargest(values, 0.1), 0.9, 2e-3);
  for (size_t i = 0; i < values.size(); ++i) {
    const auto magnitude = float((i * 377) % 1000);
    if (magnitude > 902) {
      EXPECT_EQ(std::fabs(values[i]), magnitude);
    }
    if (magnitude < 898) {
      EXPECT_EQ(values[i], 0);
    }
  }
  std::vector<float> same(10, 2.0f);
  EXPECT_EQ(keepLargest(same, 1), 0);
  EXPECT_EQ(same[0], 2);
}

// The reflectance function of a matte plane: albedo / pi times the cosine, whose mean over a row of
// boxes is exact.
TEST(LightStage, ReflectanceFunctionOfAPlaneIsItsCosine) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert({0.5f, 0.5f, 0.25f})), {-9, 0, 9}, {18, 0, 0},
          {0, 0, -18});
  const World world(scene, {}, allTables());
  const RenderSettings settings = smallRender(8, 8, 1024, 1);
  const BasisRender render = renderBasis(world, topCamera(5, 30), "lat-long:8x8", settings);
  std::vector<Image> maps;
  for (int i = 0; i < 64; ++i) maps.push_back(reflectanceFunction(render.stage, i % 8, i / 8));
  for (int row = 0; row < 8; ++row) {
    std::vector<double> ofPixels;
    for (const Image& map : maps) {
      ASSERT_EQ(map.width, 8);
      double mean = 0;
      for (int x = 0; x < 8; ++x) {
        mean += map.rgb(x, row).x / 8;
        ASSERT_NEAR(map.rgb(x, row).z, map.rgb(x, row).x / 2, 1e-5);
      }
      ofPixels.push_back(mean);
    }
    const double top = std::cos(kPiD * row / 8), bottom = std::cos(kPiD * (row + 1) / 8);
    const Moments found = Moments::of(ofPixels);
    if (row < 4) {
      EXPECT_GT(tTest(found, 0.5 / kPiD * (top + bottom) / 2), sidak(1e-3, 4))
          << row << ": " << found.mean;
    } else {
      EXPECT_EQ(found.mean, 0);
    }
  }
}

TEST(LightStage, FileKeepsItsElements) {
  const TemporaryFolder folder;
  for (const char* name : {"lat-long:8x4", "sh:2"})
    for (const bool halves : {false, true}) {
      const BasisRender render = stageOf(threeScenes()[2].scene, name, settingsOf(2));
      ASSERT_FALSE(render.stage.own.empty());
      writeStage(folder / "s.exr", render.stage, render.color, halves);
      const LightStage read = readStage(folder / "s.exr");
      EXPECT_EQ(read.basis.name(), name);
      ASSERT_EQ(read.elements.channels, render.stage.elements.channels);
      if (!halves) {
        EXPECT_EQ(read.elements.texels, render.stage.elements.texels);
        EXPECT_EQ(read.own.texels, render.stage.own.texels);
      } else {
        EXPECT_LT(relativeDifference(read.elements, render.stage.elements), 5e-4);
        EXPECT_LT(relativeDifference(read.own, render.stage.own), 5e-4);
      }
      EXPECT_EQ(readImage(folder / "s.exr").rgb(3, 4).x > 0, render.color.rgb(3, 4).x > 0);
    }
}

// In 16 bits.
TEST(LightStage, BrightNumbersAreClippedAndCounted) {
  const TemporaryFolder folder;
  BasisRender render = stageOf(threeScenes()[2].scene, "sh:1", settingsOf(2));
  render.stage.own.texels[4] = 1e9f;
  render.stage.elements.texels[5] = -1e9f;
  for (const bool halves : {false, true}) {
    StageWriter file(folder / "s.exr", render.stage, render.stage.height(), {}, halves);
    file.write(render.stage, render.color);
    EXPECT_EQ(file.clipped(), halves ? 2u : 0u);
    file.commit();
    const LightStage read = readStage(folder / "s.exr");
    EXPECT_EQ(read.own.texels[4], halves ? 65504.0f : 1e9f);
    EXPECT_EQ(read.elements.texels[5], halves ? -65504.0f : -1e9f);
  }
}

TEST(LightStage, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = threeScenes()[0].scene;
  const BasisRender all = stageOf(scene, "cube:2", settingsOf(4));
  const ThreadLimit one(1);
  const BasisRender alone = stageOf(scene, "cube:2", settingsOf(4));
  EXPECT_EQ(all.stage.elements.texels, alone.stage.elements.texels);
}

}  // namespace
}  // namespace chromeball::light_stage_test

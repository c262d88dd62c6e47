// SPDX-License-Identifier: Apache-2.0
// The number of random rays for the irradiance of an unoccluded surface.
#include "probe/random_rays.h"
#include "base/json.h"
#include "json_file.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "base/parallel.h"
#include "image/io/write_image.h"
#include "math/icosphere.h"
#include "math/vec.h"
#include "math/warp.h"
#include "probe/convert.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"
#include "test_probes.h"

namespace chromeball::random_rays_test {
namespace {

using nlohmann::json;

RayVariance upward(const Image& probe) {
  const vec3 up(0, 1, 0);
  return rayVariances(probe, std::span(&up, 1)).front();
}

// Radiance 1 above the horizon.
Image whiteSky(const ImageSize& size) {
  Image image(size.width, size.height, 3);
  for (int y = 0; y < size.height / 2; ++y)
    for (int x = 0; x < size.width; ++x) image.setRgb(x, y, Rgb(1));
  return image;
}

// Under (1 + 2 cos) / 3 above black ground: E = 7 pi/9, and the integrals of L cos^2, L^2 cos and
// L^2 cos^2 are 5 pi/9, 17 pi/27 and 64 pi/135; the integral of L is 4 pi/3.
TEST(RandomRays, OvercastSky) {
  const RayVariance v = upward(overcastProbe({512, 256}, Rgb(1), 0));
  EXPECT_NEAR(v.irradiance, 7 * kPiD / 9, 1e-4);
  EXPECT_NEAR(v.cosine, 2. / 49, 1e-4);
  EXPECT_NEAR(v.uniform, 128. * 81 / (135 * 49) - 1, 2e-4);
  EXPECT_NEAR(v.luminance, 11. / 49, 2e-4);
  EXPECT_EQ(raysForError(v.cosine, 0.1), 5);  // "tens", in the book's words: 57 if uniform
  EXPECT_EQ(raysForError(v.uniform, 0.1), 57);
}

TEST(RandomRays, WhiteSkyNeedsOneCosineSample) {
  const RayVariance v = upward(whiteSky({64, 32}));
  EXPECT_NEAR(v.cosine, 0, 1e-12);
  EXPECT_NEAR(v.uniform, 1. / 3, 1e-4);  // 1/3 error^-2 rays
  EXPECT_NEAR(v.luminance, 1. / 3, 1e-4);
  EXPECT_EQ(raysForError(v.cosine, 0.001), 1);
}

// This holds also if the map is a single texel.
TEST(RandomRays, ConstantProbe) {
  for (const ImageSize& size : {ImageSize{1, 1}, {2, 1}, {3, 7}, {64, 32}})
    for (const float radiance : {1e-8f, 1.f, 1e10f, 3e38f})
      for (const RayVariance& v :
           rayVariances(constantProbe(size, Rgb(radiance)), icosphereNormals(0))) {
        EXPECT_NEAR(v.irradiance / double(radiance), kPiD, 1e-3);
        EXPECT_NEAR(v.cosine, 0, 1e-12);
        EXPECT_NEAR(v.uniform, 1. / 3, 1e-3);
        EXPECT_NEAR(v.luminance, 5. / 3, 2e-3);
      }
}

// A small source of solid angle w at angle t: cosine sampling hits it with probability
// p = w cos(t) / pi, uniform sampling with w / (2 pi); a hit has variance (1 - p) / p.
TEST(RandomRays, OneSmallSource) {
  for (const float radiance : {1e-8f, 1e10f}) {
    const RayVariance v = upward(spot(1024, 512, 100, 90, radiance, 0));
    const double w = texelSolidAngle(90, 1024, 512), cosine = texelDirection({1024, 512}, 0, 90).y;
    EXPECT_NEAR(v.cosine / (kPiD / (w * cosine) - 1), 1, 1e-4);
    EXPECT_NEAR(v.uniform / (2 * kPiD / w - 1), 1, 1e-4);
    EXPECT_NEAR(v.luminance, 0, 1e-5);  // the cosine varies over the texel
  }
}

// A sun behind the surface changes nothing but for the rays that are drawn towards it.
TEST(RandomRays, ASunBehindTheSurface) {
  const Image sky = constantProbe({64, 32}, Rgb(1e-3f));
  Image sunny = sky;
  sunny.setRgb(10, 12, Rgb(1e10f));
  const vec3 away(-texelDirection({64, 32}, 10, 12));
  const RayVariance v = rayVariances(sunny, {&away, 1})[0],
                    plain = rayVariances(sky, {&away, 1})[0];
  EXPECT_NEAR(v.irradiance / plain.irradiance, 1, 1e-12);
  EXPECT_NEAR(v.uniform, plain.uniform, 1e-9);
  EXPECT_NEAR(v.cosine, 0, 1e-9);
  EXPECT_GT(v.luminance, 1e9);
}

TEST(RandomRays, WithoutLightThereIsNoVariance) {
  for (const RayVariance& v :
       {upward(constantProbe({8, 4}, Rgb(0))), upward(spot(8, 4, 3, 3, 1, 0))}) {
    EXPECT_EQ(v.irradiance, 0);
    EXPECT_EQ(v.uniform + v.cosine + v.luminance, 0);
  }
}

TEST(RandomRays, SameBitsForAnyNumberOfThreadsAndOtherNormals) {
  const Image probe = studioProbe({32, 16});
  const std::vector<vec3> normals = icosphereNormals(1);
  const std::vector<RayVariance> together = rayVariances(probe, normals);
  const ThreadLimit one(1);
  const std::vector<RayVariance> few = rayVariances(probe, std::span(normals).last(5));
  for (size_t i = 0; i < few.size(); ++i)
    EXPECT_EQ(few[i].cosine, together[normals.size() - 5 + i].cosine);
}

struct Moments {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double estimate) { sum += estimate, squares += estimate * estimate, ++count; }
  double mean() const { return sum / count; }
  double relativeVariance() const { return squares / count / (mean() * mean()) - 1; }
};

// One million rays of each kind against the integrals, for a surface that leans towards the lamps.
TEST(SlowRandomRays, AgreeWithMonteCarlo) {
  constexpr int kRays = 1000000;
  const Image probe = studioProbe({64, 32});
  const vec3 normal = glm::normalize(vec3(1, 2, -1));
  const RayVariance expected = rayVariances(probe, std::span(&normal, 1)).front();
  const auto luminanceAt = [&](const vec3& d) {
    const dvec2 uv = directionToUv(Mapping::LatLong, dvec3(d));
    return double(luminance(probe.rgb(std::min(int(uv.x * 64), 63), std::min(int(uv.y * 32), 31))));
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, std::nextafter(1.f, 0.f));
  std::vector<double> flux;
  for (int i = 0; i < 64 * 32; ++i)
    flux.push_back(double(luminance(probe.rgb(i % 64, i / 64))) * texelSolidAngle(i / 64, 64, 32));
  const double total = std::accumulate(flux.begin(), flux.end(), 0.);
  std::discrete_distribution<int> texels(flux.begin(), flux.end());

  const Frame frame(normal);
  Moments uniform, cosine, byLuminance;
  for (int i = 0; i < kRays; ++i) {
    const vec3 u = squareToUniformHemisphere({unit(random), unit(random)});
    uniform.add(2 * kPiD * luminanceAt(frame.toWorld(u)) * double(u.z));
    const vec3 c = squareToCosineHemisphere({unit(random), unit(random)});
    cosine.add(kPiD * luminanceAt(frame.toWorld(c)));
    // A point of a texel, uniform over its solid angle.
    const int texel = texels(random), row = texel / 64;
    const double top = std::cos(kPiD * row / 32), bottom = std::cos(kPiD * (row + 1) / 32);
    const double v = std::acos(top + unit(random) * (bottom - top)) / kPiD;
    const dvec3 d = *uvToDirection(Mapping::LatLong, {(texel % 64 + unit(random)) / 64, v});
    byLuminance.add(total * std::max(0., glm::dot(d, dvec3(normal))));
  }
  for (const Moments& m : {uniform, cosine, byLuminance})
    EXPECT_NEAR(m.mean() / expected.irradiance, 1, 0.02);
  EXPECT_NEAR(uniform.relativeVariance() / expected.uniform, 1, 0.05);
  EXPECT_NEAR(cosine.relativeVariance() / expected.cosine, 1, 0.05);
  EXPECT_NEAR(byLuminance.relativeVariance() / expected.luminance, 1, 0.05);
}

json raysOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"probe", "rays", "--json"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const CommandResult result = runCommand(all);
  EXPECT_EQ(result.status, 0) << result.error;
  return parseJson(result.out);
}

// Cosine-weighted rays for an error of 10% facing up, on maps of 256 x 128: counted by an
// independent program. The reduction of suns and lamps to a few texels decides the count, so those
// of Grace Cathedral and qwantani, which that program reduced in another way, are left out.
TEST(SlowRandomRays, OfRealProbes) {
  int found = 0;
  for (const auto& [file, expected] : {std::pair{"probulator/uffizi_latlong_small.hdr", 250.},
                                       {"debevec/galileo_probe.hdr", 9200.},
                                       {"debevec/stpeters_cross.hdr", 12300.},
                                       {"polyhaven/kloppenheim_05_1k.hdr", 449000.}})
    if (const auto path = sharedData(std::string("probes/") + file)) {
      const json rays = raysOf({path->string(), "--size", "256x128"})["rays"];
      EXPECT_NEAR(rays["cosine"]["upward"].get<double>() / expected, 1, 0.05) << file;
      EXPECT_LT(rays["luminance"]["upward"], 100) << file;
      EXPECT_LE(rays["cosine"]["median"], rays["cosine"]["max"]) << file;
      ++found;
    }
  if (found == 0) GTEST_SKIP() << "no real probes";
}

TEST(SlowCommandRays, ReportsWhatThereIs) {
  const TemporaryFolder folder;
  writeImage(folder / "sky.exr", overcastProbe({64, 32}, Rgb(1), 0));
  const json sky = raysOf({folder / "sky.exr", "--error", "0.01"});
  EXPECT_EQ(sky["error"], 0.01);
  EXPECT_NEAR(sky["rays"]["cosine"]["upward"].get<double>(), 408, 3);
  EXPECT_EQ(sky["unlit_normals"], 0);
  const CommandResult text = runCommand({"probe", "rays", folder / "sky.exr"});
  EXPECT_NE(text.out.find("cosine                  5"), std::string::npos) << text.out;

  // Half of the normals face away from a light at the pole; cosine samples find it most seldom.
  writeImage(folder / "pole.exr", oneHotProbe({64, 32}, 3, 0, Rgb(1)));
  const json pole = raysOf({folder / "pole.exr"});
  EXPECT_NEAR(pole["unlit_normals"].get<double>() / pole["normals"].get<double>(), 0.5, 0.05);
  EXPECT_GT(pole["rays"]["cosine"]["max"], pole["rays"]["cosine"]["upward"]);

  writeImage(folder / "black.exr", constantProbe({2, 1}, Rgb(0)));
  const json black = raysOf({folder / "black.exr"});
  EXPECT_TRUE(black["rays"]["uniform"]["upward"].is_null());
  EXPECT_EQ(black["unlit_normals"], black["normals"]);
}

TEST(SlowCommandRays, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr";
  writeImage(in, constantProbe({8, 4}, Rgb(1)));
  expectError({"probe", "rays"}, "PROBE");
  expectError({"probe", "rays", folder / "none.exr"}, "no such file");
  for (const char* error : {"0", "10", "nan", "-0.1"})
    expectError({"probe", "rays", in, "--error", error}, "--error: ");
  expectError({"probe", "rays", in, "--error", "much"}, "--error");
  expectError({"probe", "rays", in, "--size", "256"}, "--size");
  expectError({"probe", "rays", in, "--mapping", "angular"}, "square");
}

}  // namespace
}  // namespace chromeball::random_rays_test

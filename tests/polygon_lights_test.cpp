// SPDX-License-Identifier: Apache-2.0
// Windows and lamps of a probe as polygon sources: [[source]], `lights --suggest`.
#include "lighting/polygon_lights.h"

#include <gtest/gtest.h>

#include <fstream>

#include "front/plan_render.h"
#include "front/polygon_file.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "lighting/importance.h"
#include "lighting/scene_sources.h"
#include "math/icosphere.h"
#include "math/rotation.h"
#include "measure/statistics.h"
#include "probe/irradiance.h"
#include "probe/polygon_source.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/render_loaded.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_scene.h"
#include "transport/path_settings.h"

namespace chromeball::polygon_lights_test {
namespace {

constexpr int kWidth = 256, kHeight = 128;

// A dim room with a bright window whose corners are at texel boundaries.
Image roomWithWindow() {
  Image map = gradientProbe({kWidth, kHeight}, Rgb(0.2f, 0.25f, 0.3f), {0.2, 0.9, 0.1});
  for (int y = 30; y < 60; ++y)
    for (int x = 140; x < 170; ++x) map.setRgb(x, y, Rgb(12 + 0.1f * float(x % 5), 10, 8));
  return map;
}

const PolygonCorners kWindow{{139, 29}, {171, 29}, {171, 61}, {139, 61}};

SphericalPolygon window(const PolygonCorners& corners = kWindow) {
  LoadedProbe probe;
  probe.fileWidth = kWidth, probe.fileHeight = kHeight;
  return polygonOf(corners, probe, "test");
}

// The sources' irradiance is Lambert's; together with the remainder's, it is the map's, up to the
// shape of the window: great circles through corners one texel outside of it.
TEST(PolygonSource, KeepsEnergyAndIrradiance) {
  const Image map = roomWithWindow();
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  const PolygonSource& source = extraction.sources.front();
  const std::vector<vec3> up{{0, 1, 0}, glm::normalize(vec3(-0.5f, 0.8f, -0.3f))};
  const auto whole = exactIrradiance(map, up), rest = exactIrradiance(extraction.remainder, up);
  for (size_t i = 0; i < up.size(); ++i) {
    const double own = glm::dot(source.polygon.vectorIrradiance(), dvec3(up[i]));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR((rest[i][k] + own * source.radiance[k]) / whole[i][k], 1, 0.015);
  }
  EXPECT_GT(source.radiance.x, 8);
  EXPECT_LT(maxComponent(extraction.remainder.rgb(150, 40)), 1.5f);  // as the rim
}

// Coverage agrees with a test of every texel, also around a pole, across the seam, and for one
// texel.
TEST(PolygonSource, CoversTexelsAnywhere) {
  const Image map = constantProbe({64, 32}, Rgb(1));
  for (const dvec3& axis : {dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(0.1, 1, 0.05), dvec3(0, 0, 1),
                            dvec3(0.02, 0.1, -1), dvec3(1, 0.4, 0), dvec3(-1, -2, 0.01)})
    for (const double radius : {0.04, 0.3, 1.2}) {
      const Frame frame{vec3(glm::normalize(axis))};
      std::vector<dvec3> corners;
      for (int i = 0; i < 5; ++i) {
        const double turn = 2 * kPiD * i / 5;
        corners.push_back(glm::normalize(dvec3(
            frame.toWorld({float(std::sin(radius) * std::cos(turn)),
                           float(std::sin(radius) * std::sin(turn)), float(std::cos(radius))}))));
      }
      const SphericalPolygon polygon(corners, "test");
      double expected = 0;
      for (int y = 0; y < 4 * 32; ++y)
        for (int x = 0; x < 4 * 64; ++x)
          expected += polygon.contains(texelDirection({4 * 64, 4 * 32}, x, y)) / 16.0;
      EXPECT_EQ(extractPolygons(map, {polygon}).sources.front().coveredTexels, expected)
          << axis.x << " " << axis.y << " " << axis.z << " " << radius;
    }
}

TEST(PolygonSource, AConstantProbeStays) {
  const Image map = constantProbe({kWidth, kHeight}, Rgb(0.3f, 1e-8f, 1e10f));
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  EXPECT_EQ(extraction.remainder.texels, map.texels);
  for (int k = 0; k < 3; ++k)
    EXPECT_LE(extraction.sources.front().radiance[k], 1e-6 * double(map.texels[size_t(k)]));
}

TEST(PolygonSource, SuggestionsFindTheWindow) {
  const std::vector<SphericalPolygon> found = suggestPolygons(roomWithWindow(), 5);
  ASSERT_EQ(found.size(), 1u);
  double exact = 0;
  for (int y = 30; y < 60; ++y)
    exact += 30 * 2 * kPiD / kWidth *
             (std::cos(kPiD * y / kHeight) - std::cos(kPiD * (y + 1) / kHeight));
  EXPECT_GE(found.front().solidAngle(), exact * 0.999);
  EXPECT_LE(found.front().solidAngle(), exact * 1.1);  // the hull of curved edges
}

// A window in which the light is at the bottom.
Image unevenRoom(float atBottom) {
  Image map = roomWithWindow();
  for (int y = 30; y < 60; ++y)
    for (int x = 140; x < 170; ++x) map.setRgb(x, y, Rgb(10, 8, 6) * (y < 52 ? 1.0f : atBottom));
  return map;
}

// A directional light, but not constant radiance, keeps the irradiance of surfaces that see all of
// the light taken.
TEST(PolygonSource, UnevenLightHasItsOwnDirection) {
  const Image map = unevenRoom(30);
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  const PolygonSource& source = extraction.sources.front();
  EXPECT_GT(unevenness({&source, 1}), 0.1);
  const std::vector<vec3> up{{0, 1, 0}};
  const auto whole = exactIrradiance(map, up), rest = exactIrradiance(extraction.remainder, up);
  const double exact = whole[0].y - rest[0].y;
  const double asLight = source.direction().y * source.irradiance().y;
  const double asPolygon = source.polygon.vectorIrradiance().y * source.radiance.y;
  EXPECT_NEAR(asLight / exact, 1, 1e-3);
  EXPECT_GT(asPolygon / exact, 1.1);
  EXPECT_LT(unevenness(extractPolygons(roomWithWindow(), {window()}).sources), 0.03);
}

TEST(PolygonSource, SuggestionsDivideUnevenRegions) {
  const Image map = unevenRoom(4);
  const auto left = [&](int count) {
    const std::vector<SphericalPolygon> found = suggestPolygons(map, count);
    EXPECT_EQ(found.size(), size_t(count));
    return unevenness(extractPolygons(map, found).sources);
  };
  EXPECT_GT(left(1), 0.05);
  EXPECT_LT(left(16), 0.03);
}

std::unique_ptr<CombinedLight> withWindow(const PolygonExtraction& extraction,
                                          const Probe& remainder, const Image& map, bool isIllum) {
  Image hidden(kWidth, kHeight, 3);
  if (isIllum)
    for (size_t i = 0; i < hidden.texels.size(); ++i)
      hidden.texels[i] = map.texels[i] - extraction.remainder.texels[i];
  std::vector<std::unique_ptr<LightSource>> parts;
  parts.push_back(makeStrategy("importance", remainder, Mis::Balance, "test"));
  parts.push_back(std::make_unique<PolygonLights>(
      std::vector<PolygonLight>{{extraction.sources.front(), isIllum, "w"}}, hidden,
      remainder.rotation()));
  return std::make_unique<CombinedLight>(std::move(parts));
}

TEST(PolygonLights, PdfIsTheMixtureOfAllSamples) {
  const Image map = roomWithWindow();
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  const Probe remainder(extraction.remainder, 40);
  const auto lighting = withWindow(extraction, remainder, map, false);
  Samples samples(*lighting, {0, 1, 0});
  const auto draw = [&](int i) -> std::optional<vec3> {
    const auto& taken = samples.take(i / 2);
    EXPECT_EQ(taken.size(), 2u);
    const DirectionSample& s = taken[size_t(i % 2)];
    EXPECT_NEAR(s.pdf / lighting->escaped(samples.point(), s.wi).pdf, 1, 1e-4);
    return s.wi;
  };
  const SphereTest test = testDirections(
      draw, [&](const vec3& wi) { return lighting->escaped(samples.point(), wi).pdf / 2; }, 60000);
  EXPECT_NEAR(test.totalProbability, 1, 5e-3);
  EXPECT_GT(test.chiSquare.pValue, 1e-3);
}

// With and without a source of its own, a window gives the same irradiance; t-test of each.
TEST(PolygonLights, KeepTheIrradiance) {
  const Image map = roomWithWindow();
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  const Probe remainder(extraction.remainder);
  const vec3 normal = glm::normalize(vec3(-0.3f, 0.9f, -0.2f));
  const Frame frame(normal);
  const double own =
      glm::dot(extraction.sources.front().polygon.vectorIrradiance(), dvec3(normal)) *
      double(luminance(Rgb(extraction.sources.front().radiance)));
  const double expected =
      luminance(Rgb(exactIrradiance(extraction.remainder, std::span(&normal, 1)).front())) + own;
  for (const bool isIllum : {true, false}) {
    const auto lighting = withWindow(extraction, remainder, map, isIllum);
    Samples samples(*lighting, normal);
    std::vector<double> values;
    for (int i = 0; i < 40000; ++i) {
      double sum = 0;
      for (const DirectionSample& s : samples.take(i)) {
        const float cosine = std::max(0.0f, glm::dot(normal, s.wi));
        const float weight = s.isDelta ? 1 : misWeight(Mis::Balance, s.pdf, cosine / kPi);
        sum += luminance(s.irradiance) * cosine * weight;
      }
      const vec3 wi = frame.toWorld(squareToCosineHemisphere(random2(i, 0)));
      const float pdf = std::max(1e-6f, glm::dot(normal, wi) / kPi);
      const auto found = lighting->escaped(samples.point(), wi);
      values.push_back(sum + kPi * luminance(found.radiance) *
                                 bsdfSampleWeight(Mis::Balance, pdf, found.pdf));
    }
    const Moments moments = Moments::of(values);
    // The probe interpolates its texels: 0.3% at the window's edge.
    EXPECT_NEAR(moments.mean / expected, 1,
                3e-3 + 4 * std::sqrt(moments.variance / moments.count) / expected)
        << isIllum;
  }
}

TEST(PolygonLights, TheCameraSeesTheProbeBehindAnIllum) {
  const Image map = roomWithWindow();
  const PolygonExtraction extraction = extractPolygons(map, {window()});
  const Probe probe(map, 40), remainder(extraction.remainder, 40);
  const auto illum = withWindow(extraction, remainder, map, true);
  const auto lamp = withWindow(extraction, remainder, map, false);
  for (const vec3& wi : icosphereNormals(4)) {
    const Rgb seen = illum->background({}, wi), captured = probe.radiance(wi);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], captured[k], 1e-4f * captured[k]);
  }
  const vec3 inside(turnedAboutY(dvec3(texelDirection({kWidth, kHeight}, 155, 45)), 40));
  EXPECT_NEAR(lamp->background({}, inside).x /
                  (extraction.sources.front().radiance.x + extraction.remainder.rgb(155, 45).x),
              1, 1e-3);
}

// Each illum's group has what the camera sees of it.
TEST(PolygonLights, TellIllumsApart) {
  Image map = roomWithWindow();
  for (int y = 50; y < 70; ++y)
    for (int x = 20; x < 40; ++x) map.setRgb(x, y, Rgb(5));
  const PolygonCorners other{{19, 49}, {41, 49}, {41, 71}, {19, 71}};
  const PolygonExtraction extraction = extractPolygons(map, {window(), window(other)});
  Image hidden = map;
  for (size_t i = 0; i < hidden.texels.size(); ++i)
    hidden.texels[i] -= extraction.remainder.texels[i];
  const PolygonLights lights(
      {{extraction.sources[0], true, "a"}, {extraction.sources[1], true, "b"}}, hidden, {});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const vec3 wi(texelDirection({kWidth, kHeight}, x, y));
      std::array<Rgb, 2> radiances{Rgb(0), Rgb(0)};
      lights.splitBackground({}, wi, radiances);
      EXPECT_EQ(radiances[0] + radiances[1], lights.background({}, wi));
      EXPECT_TRUE(isBlack(radiances[x > 100 ? 1 : 0])) << x << " " << y;
    }
}

class Room {
 public:
  Room() {
    writer_.add("materials",
                {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                 {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    addTriangle(writer_, {{"material", 0}});
    writer_.save();
    writeImage(*this / "room.exr", roomWithWindow());
  }
  std::string operator/(const std::string& name) const { return writer_.folder() / name; }
  std::string scene(const std::string& text) const {
    std::ofstream(*this / "a.toml")
        << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
           "fov = 2\n[probe]\nfile = 'room.exr'\n"
        << text;
    return *this / "a.toml";
  }
  Rgb color(const std::string& text, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"render", scene(text),   "--size", "4x4", "--samples",
                                     "1024",   "--max-depth", "1",      "-o",  *this / "o.exr"};
    command.insert(command.end(), more.begin(), more.end());
    const CommandResult result = runCommand(command);
    EXPECT_EQ(result.status, 0) << result.error;
    return meanColor(readImage(*this / "o.exr"));
  }

 private:
  GltfWriter writer_;
};

TEST(SlowPolygonLights, RenderAsTheProbeItself) {
  const Room room;
  const std::string polygon = "probe_polygon = [[139, 29], [171, 29], [171, 61], [139, 61]]\n";
  const Rgb whole = room.color("");
  for (const char* kind : {"illum = true\n", "illum = false\noffset = 0.01\n"})
    for (const char* strategy : {"importance", "uniform", "bsdf"}) {
      const Rgb own = room.color("[[source]]\n" + polygon + kind, {"--strategy", strategy});
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(own[k] / whole[k], 1, 0.02) << kind << strategy;
    }
  const std::string box = "[surroundings]\nshape = 'box'\nmin = [-3, -3, -3]\nmax = [3, 3, 3]\n";
  const Rgb inBox = room.color(box), lamp = room.color(box + "[[source]]\n" + polygon);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(lamp[k] / inBox[k], 1, 0.02);
}

TEST(PolygonLights, SuggestedOnesAreReadAgain) {
  const Room room;
  const CommandResult suggest = runCommand({"lights", room / "room.exr", "--suggest", "3", "-o",
                                            room / "p.json", "--preview", room / "p.png"});
  ASSERT_EQ(suggest.status, 0) << suggest.error;
  const std::vector<PolygonCorners> polygons = readPolygons(room / "p.json");
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_NEAR(window(polygons.front()).solidAngle() /
                  suggestPolygons(roomWithWindow(), 1).front().solidAngle(),
              1, 1e-4);
  const Rgb whole = room.color(""), own = room.color("[[source]]\nfile = 'p.json'\n");
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(own[k] / whole[k], 1, 0.02);
  const CommandResult lights = runCommand(
      {"lights", room / "room.exr", "--polygons", room / "p.json", "-o", room / "l.json"});
  ASSERT_EQ(lights.status, 0) << lights.error;
  writeImage(room / "room.exr", unevenRoom(30));
  const CommandResult warned = runCommand({"render", room.scene("[[source]]\nfile = 'p.json'\n"),
                                           "--size", "4x4", "-o", room / "o.exr"});
  EXPECT_NE(warned.error.find("[[source]]: the probe is uneven"), std::string::npos)
      << warned.error;
}

TEST(PolygonLights, RefuseOthers) {
  const Room room;
  const auto refused = [&](const std::string& source, const std::string& reason) {
    expectError({"render", room.scene("[[source]]\n" + source), "-o", room / "o.exr"}, reason);
  };
  refused("", "either `probe_polygon` or `file`");
  refused("probe_polygon = [[0, 0], [10, 0]]\n", "3 to 64 corners");
  refused("probe_polygon = [[0, 30], [10, 40], [10, 30], [0, 40]]\n", "cross");
  refused("probe_polygon = [[0, 30], [10, 40], [900, 30]]\n", "no pixel");
  refused("probe_polygon = [[0, 30], [10, 40], 3]\n", "two numbers");
  refused("probe_polygon = [[0, 64], [100, 64], [200, 64]]\n", "polygon");
  refused("probe_polygon = [[20, 64], [20.01, 64], [20, 64.01]]\n",
          "smaller than the probe's texels");
  refused("file = 'none.json'\n", "none.json");
  const auto refusedToSuggest = [&](const std::string& option, const std::string& value) {
    expectError(
        {"lights", room / "room.exr", "--suggest", "2", "-o", room / "s.json", option, value},
        option + ": is for lights; --suggest writes polygons");
    EXPECT_FALSE(std::filesystem::exists(room / "s.json"));
  };
  for (const char* format : {"gltf", "csv", "opengl", "json"}) refusedToSuggest("--format", format);
  for (const char* units : {"radiometric", "photometric"}) refusedToSuggest("--light-units", units);
}

}  // namespace
}  // namespace chromeball::polygon_lights_test

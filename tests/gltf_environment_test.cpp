// SPDX-License-Identifier: Apache-2.0
// Light probes in glTF files (EXT_lights_image_based).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/probe.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball::gltf_environment_test {
namespace {

using nlohmann::json;

constexpr int kFace = 32;

// The orientation of the faces, from the figure in the specification: the direction at (u, v) in
// [-1, 1] is forward + u right + v down.
struct Face {
  vec3 forward, right, down;
};
const Face kFaces[] = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                       {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                       {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};

uint8_t encode(float radiance) {
  const float c =
      radiance <= 0.0031308f ? 12.92f * radiance : 1.055f * std::pow(radiance, 1 / 2.4f) - 0.055f;
  return uint8_t(std::lround(255 * c));
}

// A radiance between 0 and 1 that differs in all directions.
Rgb colors(const vec3& d) { return 0.5f + 0.5f * glm::normalize(d); }

// Writes a triangle lit by an environment of `radiance`, at most 1. If `scale` is not 1, the images
// are RGBD.
void addEnvironment(GltfWriter& w, Rgb (*radiance)(const vec3&) = colors, float scale = 1) {
  addTriangle(w);
  json level = json::array();
  for (int f = 0; f < 6; ++f) {
    std::vector<uint8_t> bytes;
    for (int y = 0; y < kFace; ++y)
      for (int x = 0; x < kFace; ++x) {
        const float u = 2 * (float(x) + 0.5f) / kFace - 1, v = 2 * (float(y) + 0.5f) / kFace - 1;
        const Face& face = kFaces[f];
        const Rgb c = radiance(face.forward + u * face.right + v * face.down);
        for (int k = 0; k < 3; ++k) bytes.push_back(encode(c[k]));
        if (scale != 1) bytes.push_back(uint8_t(std::lround(255 / scale)));
      }
    const std::string name = "face" + std::to_string(f) + ".png";
    w.write(name, encodePng(kFace, kFace, scale == 1 ? 3 : 4, bytes));
    level.push_back(w.add("images", {{"uri", name}}));
  }
  w.root["extensionsUsed"] = {"EXT_lights_image_based"};
  w.root["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"specularImageSize", kFace}, {"specularImages", {level}}}};
  w.root["scenes"] = {
      {{"nodes", {0}}, {"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}}};
}

json& light(GltfWriter& w) { return w.root["extensions"]["EXT_lights_image_based"]["lights"][0]; }

const std::vector<vec3>& directions() {
  static const std::vector<vec3> kDirections = [] {
    std::vector<vec3> all;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z)
          if (x || y || z) all.push_back(glm::normalize(vec3(x, y, z)));
    return all;
  }();
  return kDirections;
}

void expectRadiance(const Scene& scene, const std::function<Rgb(const vec3&)>& expected,
                    float tolerance) {
  ASSERT_TRUE(scene.environment);
  const Probe probe(*scene.environment);
  for (const vec3& d : directions())
    EXPECT_NEAR(glm::distance(probe.radiance(d), expected(d)), 0, tolerance)
        << d.x << " " << d.y << " " << d.z;
}

TEST(GltfEnvironment, FacesAreOrientedAsInTheSpecification) {
  GltfWriter w;
  addEnvironment(w);
  expectRadiance(w.load(), colors, 0.03f);
  EXPECT_TRUE(w.warnings.empty());
}

TEST(GltfEnvironment, AlphaDividesAndIntensityMultiplies) {
  GltfWriter w;
  addEnvironment(w, colors, 5);
  light(w)["intensity"] = 3;
  expectRadiance(
      w.load(), [](const vec3& d) { return 15.0f * colors(d); }, 0.45f);
}

// Faces are refused by their headers: these have no texels.
TEST(GltfEnvironment, SizesAreCheckedBeforeFacesAreDecoded) {
  for (const auto& [width, height] : {std::pair<uint8_t, uint8_t>{16, 16}, {4, 2}, {2, 4}}) {
    GltfWriter w;
    addEnvironment(w);
    std::vector<uint8_t> png = {0x89, 'P', 'N',    'G', '\r', '\n', 0x1a, '\n', 0,     0,
                                0,    13,  'I',    'H', 'D',  'R',  0,    0,    width, 0,
                                0,    0,   height, 0,   8,    2,    0,    0,    0};
    uint32_t checksum = ~0u;  // of the header (ISO/IEC 15948, annex D)
    for (size_t i = 12; i < png.size(); ++i) {
      checksum ^= png[i];
      for (int k = 0; k < 8; ++k) checksum = checksum >> 1 ^ (checksum & 1 ? 0xedb88320u : 0);
    }
    for (int shift = 24; shift >= 0; shift -= 8) png.push_back(uint8_t(~checksum >> shift));
    png.insert(png.end(), {0, 0, 0x40, 0, 'I', 'D', 'A', 'T'});
    png.resize(1 << 14);
    w.write("face0.png", png);
    const std::string error = w.errorMessage();
    EXPECT_NE(error.find(fmt::format("is {} x {}; the face of an environment must be square",
                                     256 * width, 256 * height)),
              std::string::npos)
        << error;
  }
}

TEST(GltfEnvironment, RotationIsApplied) {
  GltfWriter w;
  addEnvironment(w);
  const glm::quat q = glm::normalize(glm::quat(0.7f, 0.3f, -0.5f, 0.2f));
  light(w)["rotation"] = {q.x, q.y, q.z, q.w};
  expectRadiance(
      w.load(), [&](const vec3& d) { return colors(glm::inverse(q) * d); }, 0.03f);
}

TEST(GltfEnvironment, IsReadOnlyIfTheSceneHasItAndItIsRequested) {
  GltfWriter w;
  addEnvironment(w);
  const std::string path = w.save();
  GltfChoice choice;
  choice.environment = false;
  EXPECT_FALSE(loadGltf(path, {}, nullptr, choice).environment);
  w.root["scenes"][0].erase("extensions");
  EXPECT_FALSE(w.load().environment);
}

// The first coefficient is the mean irradiance divided by Y00.
TEST(GltfEnvironment, InconsistentCoefficientsGiveAWarning) {
  GltfWriter w;
  addEnvironment(w, [](const vec3&) { return Rgb(0.5f); });
  const float y00 = std::sqrt(1 / (4 * kPi));
  const auto coefficients = [&](float irradiance) {
    json all = json::array();
    for (int i = 0; i < 9; ++i) all.push_back(json::array({0, 0, 0}));
    all[0] = {irradiance / y00, irradiance / y00, irradiance / y00};
    return all;
  };
  light(w)["irradianceCoefficients"] = coefficients(0.5f * kPi);
  w.load();
  EXPECT_TRUE(w.warnings.empty());
  light(w)["irradianceCoefficients"] = coefficients(0.25f * kPi);
  w.load();
  ASSERT_EQ(w.warnings.size(), 1u);
  EXPECT_NE(w.warnings[0].find("2.01 times the light"), std::string::npos) << w.warnings[0];
}

TEST(GltfEnvironment, InvalidEnvironmentsAreRejected) {
  const auto errorMessage = [](const std::function<void(GltfWriter&)>& corrupt) {
    GltfWriter w;
    addEnvironment(w);
    corrupt(w);
    return w.errorMessage();
  };
  const auto expect = [&](const std::string& reason,
                          const std::function<void(GltfWriter&)>& corrupt) {
    const std::string message = errorMessage(corrupt);
    EXPECT_NE(message.find(reason), std::string::npos) << "\"" << message << "\", not " << reason;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  const char* used = "EXT_lights_image_based";
  expect("lights[1] does not exist",
         [&](auto& w) { w.root["scenes"][0]["extensions"][used]["light"] = 1; });
  expect("lights[-1] does not exist",
         [&](auto& w) { w.root["scenes"][0]["extensions"][used].erase("light"); });
  expect("lights[0] does not exist", [&](auto& w) { w.root.erase("extensions"); });
  expect("six faces", [&](auto& w) { light(w)["specularImages"][0].erase(5); });
  expect("six faces", [&](auto& w) { light(w).erase("specularImages"); });
  expect("images[99] does not exist", [&](auto& w) { light(w)["specularImages"][0][2] = 99; });
  expect("specularImages[0][2]: must be a whole number",
         [&](auto& w) { light(w)["specularImages"][0][2] = "a"; });
  expect("length 0", [&](auto& w) { light(w)["rotation"] = {0, 0, 0, 0}; });
  expect("must be square", [&](auto& w) { w.write("face3.png", kPng); });
  expect("is 1 x 1, but the first face is 32 x 32", [&](auto& w) {
    w.write("face3.png", encodePng(1, 1, 3, std::vector<uint8_t>{1, 2, 3}));
  });
  expect("damaged", [&](auto& w) {
    w.write("face3.png", {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
  });
  expect("outside of the model's folder",
         [&](auto& w) { w.root["images"][0]["uri"] = "../face0.png"; });
}

// Without a probe the environment lights the scene, with the same result as if given as a probe.
TEST(SlowGltfEnvironment, LightsTheSceneUnlessAProbeIsGiven) {
  GltfWriter w;
  addEnvironment(w, [](const vec3&) { return Rgb(1); });
  const TemporaryFolder folder;
  const std::string model = w.save(), image = folder / "a.pfm";
  const auto corner =
      [&](std::vector<std::string> more) {  // of the image, where the environment is visible
        std::vector<std::string> arguments = {"render", model, "-o",        image,
                                              "--size", "8x8", "--samples", "4"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const CommandResult result = runCommand(arguments);
        EXPECT_EQ(result.status, 0) << result.error;
        return readImage(image).rgb(7, 0).y;
      };
  EXPECT_NEAR(corner({}), 1, 1e-3f);
  EXPECT_NEAR(corner({"--probe-scale", "3"}), 3, 3e-3f);
  writeImage(folder / "probe.pfm", constantProbe({4, 2}, Rgb(0.25f)));
  EXPECT_NEAR(corner({"--probe", folder / "probe.pfm"}), 0.25f, 1e-3f);
}

}  // namespace
}  // namespace chromeball::gltf_environment_test

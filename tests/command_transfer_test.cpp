// SPDX-License-Identifier: Apache-2.0
// chromeball basis --at vertices and chromeball relight of a model as commands.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"
#include "small_model.h"

namespace chromeball::command_transfer_test {
namespace {

using Json = nlohmann::json;
using Strings = std::vector<std::string>;

class CommandTransfer : public testing::Test {
 protected:
  CommandTransfer() {
    writeSmallModel(folder_ / "m.gltf");
    writeImage(folder_ / "white.exr", constantProbe({32, 16}, Rgb(1, 2, 3)));
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(1, 2, 3), {0.3, 0.6, 0.6}));
  }

  void basis(const std::string& name, const std::string& output = "t.gltf") const {
    const CommandResult result =
        runCommand({"basis", folder_ / "m.gltf", "--at", "vertices", "--basis", name, "--samples",
                    "64", "-o", folder_ / output});
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.error, "");
  }
  CommandResult relight(const std::string& probe, const Strings& more = {}) const {
    Strings words{"relight", folder_ / "t.gltf", "--probe", folder_ / probe,
                  "-o",      folder_ / "lit.glb"};
    words.insert(words.end(), more.begin(), more.end());
    CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result;
  }
  CustomData::Arrays attributes(const std::string& file, const std::string& prefix) const {
    const CustomData data = readCustomData(folder_ / file, prefix, ExternalFiles::Refuse);
    EXPECT_EQ(data.attributes.size(), 1u);
    return data.attributes.begin()->second;
  }
  void refuses(const Strings& words, const std::string& reason) const {
    Strings all = words;
    all.insert(all.end(), {"-o", folder_ / "refused.glb"});
    expectError(all, reason);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.glb"));
  }
  void refusesBasis(const Strings& more, const std::string& reason) const {
    Strings words{"basis", folder_ / "m.gltf", "--at", "vertices"};
    words.insert(words.end(), more.begin(), more.end());
    refuses(words, reason);
  }
  void refusesRelight(const std::string& model, const Strings& more,
                      const std::string& reason) const {
    Strings words{"relight", folder_ / model, "--probe", folder_ / "probe.exr"};
    words.insert(words.end(), more.begin(), more.end());
    refuses(words, reason);
  }
  // A copy of the model with transfer whose JSON `change` changes.
  template <class Change>
  void refusesChanged(const Change& change, const std::string& reason,
                      const Strings& more = {}) const {
    Json root = jsonOfFile(folder_ / "t.gltf");
    change(root, root["meshes"][0]["primitives"][0]["attributes"]);
    std::ofstream(folder_ / "changed.gltf") << root;
    refusesRelight("changed.gltf", more, reason);
  }

  TemporaryFolder folder_;
};

// An open triangle under a constant probe has no noise: every path finds the same light, and the
// other coefficients of the light are 0.
TEST_F(CommandTransfer, ConstantLightOnAnOpenTriangle) {
  for (const auto& [name, count] : {std::pair("sh:2", 9u), std::pair("haar:2", 24u)}) {
    basis(name);
    const CustomData::Arrays transfer = attributes("t.gltf", "_PRT_");
    EXPECT_EQ(transfer.size(), count);
    EXPECT_EQ(transfer.at("_PRT_0").size(), 3u);
    EXPECT_NE(relight("white.exr").out.find("lit 3 vertices"), std::string::npos);
    const CustomData::Arrays lit = attributes("lit.glb", "_IRRADIANCE");
    for (const vec3& light : lit.at("_IRRADIANCE"))
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], kPi * float(c + 1), 2e-3f) << name;
  }
}

TEST_F(CommandTransfer, RotationTurnsTheLightAndKeepDropsCoefficients) {
  basis("sh:3");
  const auto lit = [&](const Strings& more) {
    const CommandResult result = relight("probe.exr", more);
    return attributes("lit.glb", "_IRRADIANCE").at("_IRRADIANCE");
  };
  const auto all = lit({});
  EXPECT_EQ(lit({"--keep", "16"}), all);
  EXPECT_EQ(lit({"--keep", "100%"}), all);
  EXPECT_NE(lit({"--keep", "1"}), all);
  EXPECT_NE(lit({"--rotation", "90"}), all);
  EXPECT_EQ(lit({"--rotation", "360"}).size(), 3u);
  const auto doubled = lit({"--scale", "2"});
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(doubled[i].y, 2 * all[i].y, 1e-5f * doubled[i].y);
}

// The file of transfer is the model: it still renders, and lighting it repeatedly gives the same
// bits.
TEST_F(CommandTransfer, TheModelStaysAndTheSumIsRepeatable) {
  basis("sh:1");
  relight("probe.exr");
  const std::string once = fileContents(folder_ / "lit.glb");
  relight("probe.exr");
  EXPECT_EQ(fileContents(folder_ / "lit.glb"), once);
  const CommandResult render =
      runCommand({"render", folder_ / "t.gltf", "--probe", folder_ / "probe.exr", "--size", "8x8",
                  "--samples", "1", "-o", folder_ / "o.exr"});
  EXPECT_EQ(render.status, 0) << render.error;
}

// Three vertices need two vectors: the compression is exact, and an open matte triangle under
// constant light shows its colour (white in this model, at most) from each side.
TEST_F(CommandTransfer, GlossyTransferIsSeenFromAPoint) {
  const auto glossy = [&](const char* vectors) {
    const CommandResult result = runCommand(
        {"basis", folder_ / "m.gltf", "--at", "vertices", "--basis", "sh:1", "--samples", "64",
         "--glossy", "--clusters", "1", "--vectors", vectors, "-o", folder_ / "t.gltf"});
    EXPECT_EQ(result.status, 0) << result.error;
    return result.out;
  };
  EXPECT_NE(glossy("0").find("1 clusters of 0 vectors, error"), std::string::npos);
  glossy("2");
  const Json extras = jsonOfFile(folder_ / "t.gltf")["extras"]["chromeball"];
  EXPECT_LT(extras["compressionError"].get<double>(), 1e-5);
  const auto seenFrom = [&](const std::string& eye) {
    relight("white.exr", {"--view", eye});
    return attributes("lit.glb", "_RADIANCE").at("_RADIANCE");
  };
  const auto front = seenFrom("0.3,0.3,5"), side = seenFrom("5,0.3,1");
  for (const vec3& radiance : front) {
    EXPECT_GT(radiance.x, 0.3f);
    EXPECT_LT(radiance.x, 1.05f);
    EXPECT_NEAR(radiance.z, 3 * radiance.x, 0.02f * radiance.z);
  }
  EXPECT_NE(front, side);
  refusesRelight("t.gltf", {}, "its transfer is glossy; give the eye by --view");
  refusesRelight("t.gltf", {"--view", "1,2"}, "--view");
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["tables"].erase("vector0"); },
                 "tables has no vector", {"--view", "1,2,3"});
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["origin"] = "0"; },
                 "extras.chromeball.origin: must be three numbers", {"--view", "1,2,3"});
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["basis"] = "sh:3"; }, "elements",
                 {"--view", "1,2,3"});
  refusesChanged([](Json&, Json& a) { a["_PRT_0"] = a["POSITION"]; }, "is not a cluster, 0 to 0",
                 {"--view", "1,2,3"});
  refusesChanged([](Json&, Json& a) { a.erase("_PRT_NORMAL"); }, "has no _PRT_NORMAL",
                 {"--view", "1,2,3"});
  basis("sh:1");
  refusesRelight("t.gltf", {"--view", "1,2,3"}, "--view: the model's transfer is diffuse");
}

// A ball of a rough metal.
std::string writeBall(GltfWriter& w) {
  constexpr int kRows = 16, kColumns = 32;
  std::vector<float> positions;
  std::vector<uint16_t> indices;
  for (int r = 0; r <= kRows; ++r)
    for (int c = 0; c <= kColumns; ++c) {
      const double theta = kPiD * r / kRows, phi = 2 * kPiD * c / kColumns;
      positions.insert(positions.end(),
                       {float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)),
                        float(std::sin(theta) * std::cos(phi))});
    }
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const auto a = uint16_t(r * (kColumns + 1) + c), b = uint16_t(a + kColumns + 1);
      if (r > 0) indices.insert(indices.end(), {a, b, uint16_t(a + 1)});
      if (r + 1 < kRows) indices.insert(indices.end(), {uint16_t(a + 1), b, uint16_t(b + 1)});
    }
  w.add("materials", {{"pbrMetallicRoughness",
                       {{"baseColorFactor", {.9, .6, .3, 1}}, {"roughnessFactor", .5}}}});
  const int mesh =
      w.mesh({{"material", 0},
              {"indices", w.indices(indices)},
              {"attributes", {{"POSITION", w.vec3s(positions)}, {"NORMAL", w.vec3s(positions)}}}});
  w.add("nodes", {{"mesh", mesh}});
  return w.save();
}

using SlowCommandTransfer = CommandTransfer;

// Under light that the basis represents exactly, the view equals a render.
TEST_F(SlowCommandTransfer, GlossySurfacesLookAsRendered) {
  GltfWriter ball;
  const std::string model = writeBall(ball);
  const auto run = [](const Strings& words) {
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
  };
  run({"basis", model, "--at", "vertices", "--basis", "sh:2", "--glossy", "--clusters", "8",
       "--vectors", "16", "--samples", "512", "-o", folder_ / "t.gltf"});
  // An image of the ball, whose radiance is `white` times the file's colours.
  const auto seen = [&](const std::string& file, const std::string& eye, float white) {
    const std::string scene = folder_ / "seen.toml";
    std::ofstream(scene) << "model = \"" << file << "\"\n[camera]\nposition = [" << eye
                         << "]\nlook_at = [0, 0, 0]\nfov = 40\n";
    run({"render", scene, "--probe", folder_ / "probe.exr", "--size", "48x48", "--samples", "256",
         "--adaptive", "off", "--transparent", "-o", folder_ / "seen.pfm"});
    Image image = readImage(folder_ / "seen.pfm");
    for (float& texel : image.texels) texel *= white;
    return image;
  };
  const auto difference = [](const Image& a, const Image& b) {
    double squares = 0, all = 0;
    for (size_t i = 0; i < a.texels.size(); ++i) {
      squares += std::pow(double(a.texels[i]) - double(b.texels[i]), 2);
      all += std::pow(double(b.texels[i]), 2);
    }
    return std::sqrt(squares / all);
  };
  const std::string eye = "2,1.5,3", other = "-2,-1,-3";
  const Image rendered = seen(model, eye, 1);
  const auto errorFrom = [&](const std::string& view) {
    relight("probe.exr", {"--view", view, "--white", "4"});
    return difference(seen(folder_ / "lit.glb", eye, 4), rendered);
  };
  // The remaining error comes from the noise of 512 paths, 25 directions, and colours between
  // vertices.
  EXPECT_LT(errorFrom(eye), 0.05);
  EXPECT_GT(errorFrom(other), 0.08) << "it must be able to fail";
}

TEST_F(CommandTransfer, AFarEyeSeesItsDirection) {
  const CommandResult made =
      runCommand({"basis", folder_ / "m.gltf", "--at", "vertices", "--basis", "sh:1", "--samples",
                  "16", "--glossy", "-o", folder_ / "t.gltf"});
  ASSERT_EQ(made.status, 0) << made.error;
  const auto seenFrom = [&](const std::string& eye) {
    relight("probe.exr", {"--view", eye});
    return attributes("lit.glb", "_RADIANCE").at("_RADIANCE");
  };
  const auto far = seenFrom("1e9,0,1e9"), farthest = seenFrom("1e300,0,1e300");
  const auto above = seenFrom("0,0,1e9");
  for (size_t i = 0; i < far.size(); ++i) {  // vertices are 1e-9 of the distance from the origin
    EXPECT_NEAR(glm::distance(far[i], farthest[i]), 0, 1e-6f * glm::length(far[i]));
    EXPECT_GT(glm::distance(far[i], above[i]), 1e-3f * glm::length(far[i])) << "another direction";
  }
}

TEST_F(CommandTransfer, RefusesBadOptions) {
  refusesBasis({"--clusters", "2"}, "--clusters, --vectors: need --glossy");
  refusesBasis({"--glossy", "--clusters", "0"}, "--clusters");
  refuses({"basis", folder_ / "m.gltf", "--glossy"}, "--glossy: needs --at vertices");
  refusesBasis({"--basis", "sh:9"}, "--basis: `sh:9` is not sh:ORDER");
  refusesBasis({"--basis", "haar:3"}, "--basis: `haar:3` is not");
  refusesBasis({"--directions", "sh:2"}, "--directions: has no effect with --at vertices");
  refusesBasis({"--half"}, "--half: has no effect with --at vertices");
  refusesBasis({"--size", "9x9"}, "--size: has no effect with --at vertices");
  refusesBasis({"--max-depth", "0"}, "--max-depth");
  refuses({"basis", folder_ / "m.gltf", "--at", "texels"}, "--at: `texels` is not pixels");
  refuses({"basis", folder_ / "m.gltf", "--basis", "sh:2"}, "--basis: needs --at vertices");
  expectError({"basis", folder_ / "m.gltf", "--at", "vertices", "-o", folder_ / "o.exr"}, ".glb");
  std::ofstream(folder_ / "c.toml") << "[composite]\nplate = \"white.exr\"\nmodel = \"m.gltf\"\n";
  const CommandResult composite =
      runCommand({"basis", folder_ / "c.toml", "--at", "vertices", "-o", folder_ / "refused.glb"});
  EXPECT_EQ(composite.status, 2);

  basis("sh:1");
  for (const char* keep : {"0", "5", "1.5", "101%", "0%", "-1", "x", "nan"})
    refusesRelight("t.gltf", {"--keep", keep}, "--keep");
  refusesRelight("t.gltf", {"--domain", "haar"}, "--domain: has no effect on a model");
  refusesRelight("t.gltf", {"--preview"}, "--preview: has no effect on a model");
  refusesRelight("t.gltf", {"--exposure", "1"}, "--exposure: has no effect on a model");
  refusesRelight("t.gltf", {"--white", "0"}, "--white");
  refusesRelight("t.gltf", {"--probe", folder_ / "white.exr"}, "--probe: give one");
  refuses({"relight", folder_ / "t.gltf"}, "--probe: give one");
  refuses({"relight", folder_ / "none.exr", "--probe", folder_ / "white.exr", "--white", "1"},
          "--white: needs a model");
}

TEST_F(CommandTransfer, RefusesBadModels) {
  refusesRelight("m.gltf", {}, "has no transfer (_PRT_0)");
  refusesRelight("none.gltf", {}, "none.gltf");
  basis("sh:1");
  refusesChanged([](Json&, Json& a) { a.erase("_PRT_2"); }, "has no _PRT_2; sh:1 has 4 functions");
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"].erase("basis"); },
                 "has no transfer");
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["basis"] = "sh:2"; },
                 "has no _PRT_4; sh:2 has 9 functions");
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["basis"] = "haar:1073741824"; },
                 "extras.chromeball.basis: `haar:1073741824` is not");
  refusesChanged([](Json& r, Json&) { r["extras"]["chromeball"]["basis"] = 3; }, "has no transfer");
  refusesChanged([](Json& r, Json&) { r["nodes"][0]["rotation"] = {0, 1, 0, 0}; }, "is turned");
  refusesChanged([](Json& r, Json&) { r["nodes"][0]["scale"] = {-1, 1, 1}; }, "or mirrored");
  refusesChanged([](Json& r, Json& a) { r["accessors"][a["_PRT_1"].get<size_t>()]["count"] = 2; },
                 "_PRT_1 has 2 elements for 3 vertices");
  refusesChanged(
      [](Json& r, Json& a) { r["accessors"][a["_PRT_1"].get<size_t>()]["count"] = 1000000000; },
      "_PRT_1");
  refusesChanged(
      [](Json& r, Json& a) { r["accessors"][a["_PRT_1"].get<size_t>()]["type"] = "VEC2"; },
      "_PRT_1");
  refusesChanged([](Json&, Json& a) { a["_PRT_1"] = 99999; }, "_PRT_1");
}

TEST_F(CommandTransfer, RefusesValuesThatAreNotFinite) {
  basis("sh:0", "t.glb");
  std::string bytes = fileContents(folder_ / "t.glb");
  const vec3 first = attributes("t.glb", "_PRT_0").at("_PRT_0")[0];
  const std::string pattern(reinterpret_cast<const char*>(&first), sizeof first);
  const size_t at = bytes.find(pattern);
  ASSERT_NE(at, std::string::npos);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bytes.replace(at, sizeof nan, reinterpret_cast<const char*>(&nan), sizeof nan);
  std::ofstream(folder_ / "nan.glb", std::ios::binary) << bytes;
  refusesRelight("nan.glb", {}, "_PRT_0: element 0 is not finite");
}

}  // namespace
}  // namespace chromeball::command_transfer_test

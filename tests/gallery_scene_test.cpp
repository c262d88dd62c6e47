// SPDX-License-Identifier: Apache-2.0
// The models of the gallery: closed forms of their shapes, and properties that every model needs to
// be lit correctly.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>

#include "base/json.h"
#include "demo/doric.h"
#include "demo/gallery.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"
#include "trace/accel.h"

namespace chromeball::gallery_scene_test {
namespace {

using demo::Nave;

const std::map<std::string, std::function<void(const std::string&)>> kModels = {
    {"five-shapes", demo::writeFiveShapes},
    {"rnl", demo::writePedestal},
    {"temple", demo::writeTemple},
    {"nave", [](const std::string& path) { demo::writeNave(path, Nave::Whole); }},
    {"nave-room", [](const std::string& path) { demo::writeNave(path, Nave::Room); }},
    {"nave-things", [](const std::string& path) { demo::writeNave(path, Nave::Things); }}};

// The model's file, written once.
std::string fileOf(const std::string& name) {
  static const TemporaryFolder folder;
  const std::string path = folder / (name + ".glb");
  if (!std::filesystem::exists(path)) kModels.at(name)(path);
  return path;
}

const Scene& modelOf(const std::string& name) {
  static std::map<std::string, Scene> scenes;
  if (!scenes.contains(name)) scenes[name] = loadGltf(fileOf(name), {}, nullptr);
  return scenes[name];
}

class SlowGallery : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Models, SlowGallery,
                         testing::Values("five-shapes", "rnl", "temple", "nave", "nave-room",
                                         "nave-things"));

TEST_P(SlowGallery, NormalsAreUnitAndOnTheFrontOfTheirTriangles) {
  const Scene& scene = modelOf(GetParam());
  EXPECT_EQ(scene.cameras.at(0).name, "View");
  for (const Mesh& mesh : scene.meshes)
    for (const Triangle& t : mesh.triangles) {
      const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      const vec3 front = glm::normalize(glm::cross(b - a, c - a));
      for (const uint32_t i : {t.x, t.y, t.z}) {
        ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5f);
        // Less than a right angle, also where a profile has an edge.
        ASSERT_GT(glm::dot(mesh.normals[i], front), 0.15f) << a.x << ' ' << a.y << ' ' << a.z;
      }
    }
}

TEST_P(SlowGallery, EveryTriangleHasAreaInItsTexture) {
  for (const Mesh& mesh : modelOf(GetParam()).meshes)
    for (const auto& uvs : mesh.uvs)
      for (const Triangle& t : mesh.triangles) {
        const vec2 b = uvs[t.y] - uvs[t.x], c = uvs[t.z] - uvs[t.x];
        ASSERT_GT(std::abs(b.x * c.y - b.y * c.x), 0) << uvs[t.x].x << ' ' << uvs[t.x].y;
      }
}

// The divergence theorem: area vectors of a closed body add up to 0, and its volume is a third of
// the sum of position . area.
TEST_P(SlowGallery, BodiesOfGlassAreClosedAndFaceOut) {
  const Scene& scene = modelOf(GetParam());
  for (const Instance& instance : scene.instances) {
    if (!scene.materials[instance.material].isBody()) continue;
    const Mesh& mesh = scene.meshes[instance.mesh];
    glm::dvec3 sum(0);
    double area = 0, volume = 0;
    for (const Triangle& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
      const glm::dvec3 vector = 0.5 * glm::cross(b - a, c - a);
      sum += vector;
      area += glm::length(vector);
      volume += glm::dot(a, vector) / 3;
    }
    EXPECT_LT(glm::length(sum), 1e-6 * area);
    EXPECT_GT(volume, 0);
    // The isoperimetric inequality, an equality for balls: 36 pi V^2 <= A^3.
    const double roundness = 36 * kPiD * volume * volume / (area * area * area);
    EXPECT_LE(roundness, 1);
    EXPECT_GT(roundness, 0.5);
  }
}

TEST_P(SlowGallery, RendersWithoutWarningsAndInvalidSamples) {
  const TemporaryFolder folder;
  const std::string model = fileOf(GetParam()), stats = folder / "stats.json";
  const CommandResult result = runCommand(
      {"render", model, "--probe", std::string(kSourceDir) + "/probes/noon.exr", "--size", "48x32",
       "--samples", "4", "--max-depth", "12", "-o", folder / "image.exr", "--stats", stats});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.error.find("warning"), std::string::npos) << result.error;
  EXPECT_EQ(jsonOfFile(stats).at("invalid_samples"), 0);
}

TEST(SlowGalleryScenes, AreCompleteWithTheModelsThatTheirHeadersName) {
  const TemporaryFolder folder;
  namespace fs = std::filesystem;
  fs::create_directories(folder / "scenes");
  fs::create_directories(folder / "out");
  fs::create_directory_symlink(fs::path(kSourceDir) / "probes", folder / "probes");
  for (const char* name : {"five-shapes", "rnl", "temple", "nave"}) {
    const fs::path source = fs::path(kSourceDir) / "scenes" / (std::string(name) + ".toml");
    const std::string scene = folder / ("scenes/" + source.filename().string());
    fs::copy_file(source, scene);
    const std::string text = fileContents(scene), model = std::string("out/") + name + ".glb";
    EXPECT_NE(text.find("build/make_demo " + std::string(name) + " " + model), std::string::npos);
    fs::copy_file(fileOf(name), folder / model);
    const CommandResult result = runCommand(
        {"render", scene, "--size", "32x32", "--samples", "2", "-o", folder / "out/image.png"});
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.error.find("warning"), std::string::npos) << result.error;
  }
}

TEST(Gallery, AColumnHasItsTaperAndEntasis) {
  const demo::DoricColumn column;
  EXPECT_DOUBLE_EQ(demo::radiusAt(column, 0), column.lowerRadius);
  EXPECT_DOUBLE_EQ(demo::radiusAt(column, column.shaft), column.upperRadius);
  EXPECT_DOUBLE_EQ(demo::radiusAt(column, column.shaft / 2),
                   (column.lowerRadius + column.upperRadius) / 2 + column.entasis);
  const demo::Surface shaft = demo::shaft(column);
  std::map<float, double> outermost, innermost;  // by height
  for (const vec3& p : shaft.positions) {
    const double radius = std::hypot(double(p.x), double(p.z));
    outermost[p.y] = std::max(outermost[p.y], radius);
    double& least = innermost.try_emplace(p.y, radius).first->second;
    least = std::min(least, radius);
  }
  EXPECT_EQ(outermost.size(), 13u);
  for (const auto& [height, radius] : outermost) {
    EXPECT_NEAR(radius, demo::radiusAt(column, height), 1e-6);  // the arrises
    EXPECT_LT(innermost[height], 0.94 * radius);                // the flutes
    EXPECT_GT(innermost[height], 0.92 * radius);
  }
}

TEST(SlowGallery, TheTempleSharesTheMeshesOfItsColumns) {
  const Scene& scene = modelOf("temple");
  std::map<int, int> uses;
  for (const Instance& instance : scene.instances) ++uses[instance.mesh];
  std::vector<int> counts;
  for (const auto& [mesh, count] : uses) counts.push_back(count);
  std::ranges::sort(counts);
  // 8 by 17 columns around, and six before each end: shafts and capitals; a triglyph over each
  // column and between two.
  const std::vector<int> expected = {1, 1, 1, 1, 1, 46 + 12, 46 + 12, 2 * (15 + 33)};
  EXPECT_EQ(counts, expected);
  EXPECT_GT(scene.triangleCount(), 200'000u);
  EXPECT_LT(scene.triangleCount(), 350'000u);
}

// Where the sun's ray through the middle of a window of the clerestory meets the floor there is
// sun; the wall between two windows shades the place half a bay farther along.
TEST(SlowGallery, SunThroughTheWindowsOfTheNaveIsWhereGeometryPutsIt) {
  const Accel accel(modelOf("nave-room"));
  const demo::NaveMeasures nave;
  const vec3 sun(sunDirection({.sunElevation = 42, .sunAzimuth = 140}));
  ASSERT_LT(sun.x, 0);
  int within = 0;
  for (int i = 0; i < nave.bays; ++i) {
    const vec3 window = nave.window(i, -1);
    const vec3 lit = window - sun * (window.y / sun.y), shade = lit + vec3(0, 0, nave.bay / 2);
    if (std::abs(shade.z) > nave.halfLength() || std::abs(lit.z) > nave.halfLength()) continue;
    ++within;
    for (const auto& [place, expected] : {std::pair(lit, 1.0f), std::pair(shade, 0.0f)})
      EXPECT_EQ(accel.transmittance({place + vec3(0, 1e-3f, 0), sun}).x, expected) << i;
  }
  EXPECT_GE(within, 4);
}

// Nothing is missing in the room: from its middle the sky is seen through openings alone.
TEST(SlowGallery, TheNaveIsClosedButForItsWindows) {
  const Accel accel(modelOf("nave-room"));
  const demo::NaveMeasures nave;
  const vec3 eye(0.3f, 2, 1.1f);
  int open = 0;
  constexpr int kRays = 20'000;
  for (int i = 0; i < kRays; ++i) {  // Fibonacci's lattice on the sphere
    const float y = 1 - 2 * (float(i) + 0.5f) / kRays, bearing = 2.39996323f * float(i);
    const float r = std::sqrt(1 - y * y);
    const vec3 direction(r * std::cos(bearing), y, r * std::sin(bearing));
    Hit hit;
    if (accel.intersect({eye, direction}, 0, hit)) continue;
    ++open;
    EXPECT_GT(direction.y, 0);
    const vec3 wall = eye + direction * ((nave.halfWidth + nave.wall / 2) / std::abs(direction.x));
    const bool side = std::abs(wall.z) < nave.halfLength();
    if (side && wall.y > nave.clerestory) {
      const float z = wall.z / nave.bay + 0.5f * float(nave.bays);
      EXPECT_LT(std::abs(z - std::floor(z) - 0.5f) * nave.bay, nave.windowHalfWidth + 0.4f);
      EXPECT_GT(wall.y, nave.clerestory + nave.windowSill - 0.5f);
      EXPECT_LT(wall.y, nave.clerestory + nave.windowSpring + nave.windowHalfWidth + 0.5f);
    }
  }
  EXPECT_GT(open, kRays / 200);
  EXPECT_LT(open, kRays / 10);
}

// The conch of the apse rests on its wall, all the way round.
TEST(SlowGallery, TheApseIsClosedUnderItsConch) {
  const Accel accel(modelOf("nave-room"));
  const demo::NaveMeasures nave;
  const vec3 centre(0, nave.apseSpring, -nave.halfLength() - nave.wall);
  for (int i = 1; i < 2000; ++i) {
    const float bearing = kPi * float(i) / 2000;
    for (const float elevation : {-0.004f, -0.001f, 0.001f, 0.002f, 0.004f}) {
      Hit hit;
      EXPECT_TRUE(accel.intersect(
          {centre, glm::normalize(vec3(std::cos(bearing), elevation, -std::sin(bearing)))}, 0, hit))
          << bearing << ' ' << elevation;
    }
  }
}

TEST(Gallery, WrongArgumentsOfMakeDemoGiveOneLine) {
  const std::string program = std::string(kBuildDir) + "/make_demo";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "built without CHROMEBALL_DEMO";
  const TemporaryFolder folder;
  const std::string error = folder / "error";
  for (const std::string& arguments :
       {std::string(), std::string("nonsense a.glb"), "rnl " + (folder / "a.exr"),
        "dusk " + (folder / "a.glb"), std::string("rnl /no/such/folder/a.glb")}) {
    const std::string line = program + " " + arguments + " 2> " + error;
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 2) << arguments;
    const std::string text = fileContents(error);
    EXPECT_EQ(std::ranges::count(text, '\n'), 1) << text;
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"error"});
}

}  // namespace
}  // namespace chromeball::gallery_scene_test

// SPDX-License-Identifier: Apache-2.0
// Cube maps in six files: orientation, messages, and one face alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "base/error.h"
#include "front/plan_render.h"
#include "front/scene_file.h"
#include "image/io/write_image.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/probe.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/image_header.h"
#include "session/load_scene.h"
#include "shared_data.h"
#include "small_model.h"

namespace chromeball::cube_faces_test {
namespace {

constexpr int kSide = 12;

// A smooth light that differs in all directions, in a mapping of square faces.
Image cubeMap(Mapping mapping) {
  const Image sky = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.3, 0.5, -0.2});
  const Layout layout = faceLayout(mapping);
  return convert(sky, Mapping::LatLong, mapping, {layout.columns * kSide, layout.rows * kSide});
}

Image face(const Image& map, int column, int row, int side = kSide) {
  return colorImage(side, side,
                    [&](int x, int y) { return map.rgb(column * side + x, row * side + y); });
}

// Writes the faces of a horizontal strip under these names.
void writeFaces(const TemporaryFolder& folder, const Image& strip,
                const std::vector<std::string>& names) {
  for (size_t i = 0; i < names.size(); ++i)
    writeImage(folder / names[i], face(strip, int(i), 0, strip.height));
}

void writeCube(const TemporaryFolder& folder) {
  writeFaces(folder, cubeMap(Mapping::HorizontalStrip),
             {"px.exr", "nx.exr", "py.exr", "ny.exr", "pz.exr", "nz.exr"});
}

std::string folderOf(const TemporaryFolder& folder) {
  return std::filesystem::path(folder / "x").parent_path().string();
}

Image latLongOf(const TemporaryFolder& folder) { return loadProbe(folderOf(folder)).latLong; }

Image latLongOf(const Image& cube, Mapping mapping) {
  return convert(cube, mapping, Mapping::LatLong, latLongSize(mapping, {cube.width, cube.height}));
}

TEST(CubeFaces, SidesAreThoseOfACross) {
  const TemporaryFolder folder;
  const Image cross = cubeMap(Mapping::HorizontalCross);
  const std::tuple<const char*, int, int> kSides[] = {
      {"Room_Left.exr", 0, 1}, {"Room_Front.exr", 1, 1}, {"Room_Right.exr", 2, 1},
      {"Room_Back.exr", 3, 1}, {"Room_Top.exr", 1, 0},   {"Room_Bottom.exr", 1, 2}};
  for (const auto& [name, column, row] : kSides)
    writeImage(folder / name, face(cross, column, row));
  std::ofstream(folder / "readme.txt") << "six faces";
  const Image found = latLongOf(folder), expected = latLongOf(cross, Mapping::HorizontalCross);
  ASSERT_EQ(found.texels.size(), expected.texels.size());
  for (size_t i = 0; i < found.texels.size(); ++i)
    EXPECT_NEAR(found.texels[i], expected.texels[i], 0.01f);
}

// The names of OpenEXR's axes, and those of a graphics API, in which the front is pz.
TEST(CubeFaces, TheEdgesTellWhoseAxesTheNamesAre) {
  const Image strip = cubeMap(Mapping::HorizontalStrip);
  const Image expected = latLongOf(strip, Mapping::HorizontalStrip);
  const auto noteOf = [&](const std::vector<std::string>& names) {
    const TemporaryFolder folder;
    writeFaces(folder, strip, names);
    const LoadedProbe probe = loadProbe(folderOf(folder));
    EXPECT_EQ(probe.latLong.texels, expected.texels);
    EXPECT_EQ(probe.mapping, Mapping(Mapping::HorizontalStrip));
    EXPECT_EQ(probe.files.size(), 6u);
    return probe.messages.at(0).text;
  };
  EXPECT_NE(noteOf({"px.exr", "nx.exr", "py.exr", "ny.exr", "pz.exr", "nz.exr"}).find("OpenEXR"),
            std::string::npos);
  EXPECT_NE(noteOf({"posx.exr", "negx.exr", "posy.exr", "negy.exr", "negz.exr", "posz.exr"})
                .find("fit as in OpenGL"),
            std::string::npos);
}

// Names that say which face is where are believed, but not in silence.
TEST(CubeFaces, EdgesThatFitWithFrontAndBackExchangedAreSaid) {
  const Image strip = cubeMap(Mapping::HorizontalStrip);
  const auto messages = [&](const std::vector<std::string>& names) {
    const TemporaryFolder folder;
    writeFaces(folder, strip, names);
    std::string all;
    for (const Message& message : loadProbe(folderOf(folder)).messages) all += message.text;
    return all;
  };
  constexpr const char* kExchanged = "front and back exchanged";
  EXPECT_EQ(messages({"right.exr", "left.exr", "top.exr", "bottom.exr", "back.exr", "front.exr"})
                .find(kExchanged),
            std::string::npos);
  EXPECT_NE(messages({"right.exr", "left.exr", "top.exr", "bottom.exr", "front.exr", "back.exr"})
                .find(kExchanged),
            std::string::npos);
}

// Edges of one colour do not tell: pz is the front, as in most programs that write six files.
TEST(CubeFaces, FacesOfOneColourAreSeenAlongOpenGlsAxes) {
  const TemporaryFolder folder;
  const std::pair<const char*, vec3> kAxes[] = {{"px", {1, 0, 0}},  {"nx", {-1, 0, 0}},
                                                {"py", {0, 1, 0}},  {"ny", {0, -1, 0}},
                                                {"pz", {0, 0, -1}}, {"nz", {0, 0, 1}}};
  float brightness = 0;
  for (const auto& [name, axis] : kAxes)
    writeImage(folder / (name + std::string(".hdr")),
               constantProbe({kSide, kSide}, Rgb(++brightness)));
  const Probe probe(latLongOf(folder), {});
  brightness = 0;
  for (const auto& [name, axis] : kAxes)
    EXPECT_NEAR(probe.radiance(axis).x, ++brightness, 0.02f) << name;
}

// Multiplies each texel by a number around 1.
void addNoise(Image& image, float amplitude, uint32_t seed) {
  std::mt19937 random(seed);
  for (float& value : image.texels)
    value *= 1 + amplitude * (2 * float(random()) / float(random.max()) - 1);
}

std::string orientationNote(const Image& strip, const std::vector<std::string>& names) {
  const TemporaryFolder folder;
  writeFaces(folder, strip, names);
  return loadProbe(folderOf(folder)).messages.at(0).text;
}

const std::vector<std::string> kOpenExr = {"px.pfm", "nx.pfm", "py.pfm",
                                           "ny.pfm", "pz.pfm", "nz.pfm"},
                               kOpenGl = {"px.pfm", "nx.pfm", "py.pfm",
                                          "ny.pfm", "nz.pfm", "pz.pfm"};

// Faces of one colour, also of different ones, whose edges differ by noise alone.
TEST(SlowCubeFaces, NoiseDoesNotDecide) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Image strip = constantProbe({6 * kSide, kSide}, Rgb(0.002f));
    for (int face = 0; seed % 2 && face < 6; ++face)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          strip.setRgb(face * kSide + x, y, Rgb(0.01f * float(face + 1)));
    addNoise(strip, seed % 4 < 2 ? 0.02f : 0.5f, seed);
    EXPECT_NE(orientationNote(strip, kOpenExr).find("the edges do not tell"), std::string::npos)
        << seed;
  }
}

TEST(SlowCubeFaces, NoiseHidesNoClearEdges) {
  const Image clean = cubeMap(Mapping::HorizontalStrip);
  for (uint32_t seed = 0; seed < 5; ++seed) {
    Image strip = clean;
    addNoise(strip, 0.05f, seed);
    EXPECT_NE(orientationNote(strip, kOpenExr).find("fit as in OpenEXR"), std::string::npos);
    EXPECT_NE(orientationNote(strip, kOpenGl).find("fit as in OpenGL"), std::string::npos);
  }
}

TEST(CubeFaces, AFolderThatIsNoCubeMapIsRefused) {
  const TemporaryFolder folder;
  const auto refuses = [&](const std::string& reason) {
    expectError({"probe", "info", folderOf(folder)}, reason);
  };
  refuses("is a folder without a cube map");
  writeCube(folder);
  std::filesystem::remove(folder / "ny.exr");
  refuses("its cube map has no file ny");
  writeImage(folder / "ny.exr", constantProbe({kSide, 2 * kSide}, Rgb(1)));
  refuses("ny.exr: is 12 x 24; the face of a cube map must be square");
  writeImage(folder / "ny.exr", constantProbe({16, 16}, Rgb(1)));
  refuses("ny.exr: is 16 x 16, but px.exr is 12 x 12");
  writeCube(folder);
  expectError({"probe", "info", folderOf(folder), "--mapping", "angular"},
              "--probe-mapping: " + folderOf(folder) + " is a folder with the faces of a cube map");
  writeImage(folder / "PX.hdr", constantProbe({kSide, kSide}, Rgb(1)));
  refuses("PX.hdr and px.exr are the same face");
  std::filesystem::remove(folder / "PX.hdr");
  writeFaces(folder, cubeMap(Mapping::HorizontalStrip),
             {"b.px.exr", "b.nx.exr", "b.py.exr", "b.ny.exr", "b.pz.exr", "b.nz.exr"});
  refuses("has 2 cube maps");
}

TEST(CubeFaces, OneFaceAloneIsNoMirrorBall) {
  const TemporaryFolder folder;
  writeCube(folder);
  expectError({"probe", "info", folder / "pz.exr"},
              "is one face of a cube map, whose probe is the folder " + folderOf(folder) + ";");
  EXPECT_EQ(loadProbe(folder / "pz.exr", "mirror-ball").mapping, Mapping(Mapping::MirrorBall));
  std::filesystem::remove(folder / "px.exr");  // and is not there
  expectError({"probe", "info", folder / "pz.exr"}, "is one face of a cube map");
  // Photographs of a ball from its sides.
  for (const char* side : {"front.exr", "back.exr", "left.exr", "right.exr"})
    writeImage(folder / side, constantProbe({kSide, kSide}, Rgb(1)));
  EXPECT_EQ(loadProbe(folder / "front.exr").mapping, Mapping(Mapping::MirrorBall));
}

TEST(CubeFaces, AFolderIsAProbeOfScenes) {
  const TemporaryFolder folder, faces;
  writeCube(faces);
  writeSmallModel(folder / "model.gltf");
  std::ofstream(folder / "scene.toml")
      << fmt::format("model = \"model.gltf\"\n[probe]\nfile = \"{}\"\n", folderOf(faces));
  const auto load = [&] { return loadScene(planRender(openScene(folder / "scene.toml"))); };
  const LoadedScene loaded = load();
  EXPECT_EQ(loaded.files.size(), 1u + 6u);
  EXPECT_EQ(loaded.loadedProbe.fileWidth, 6 * kSide);
  const std::string identity = renderIdentity(loaded);
  EXPECT_EQ(identity, renderIdentity(load()));
  writeImage(faces / "py.exr", constantProbe({kSide, kSide}, Rgb(9)));
  EXPECT_NE(identity, renderIdentity(load()));
}

// Real light tells its axes in either convention.
TEST(SlowCubeFaces, RealEdgesTell) {
  for (const char* name : {"polyhaven/venice_sunset_1k.hdr", "polyhaven/studio_small_05_1k.hdr",
                           "polyhaven/hilly_terrain_01_1k.hdr", "openexr/StageEnvLatLong.exr"}) {
    const auto file = sharedData(std::string("probes/") + name);
    if (!file) GTEST_SKIP() << "../shared/data/probes is not there";
    const Image strip =
        convert(loadProbe(*file).latLong, Mapping::LatLong, Mapping::HorizontalStrip, {6 * 32, 32});
    EXPECT_NE(orientationNote(strip, kOpenExr).find("fit as in OpenEXR"), std::string::npos)
        << name;
    EXPECT_NE(orientationNote(strip, kOpenGl).find("fit as in OpenGL"), std::string::npos) << name;
  }
}

// The faces and the lat-long map are of one probe, in which three.js and the lat-long map's maker
// have put the front 90 degrees apart.
TEST(SlowCubeFaces, PisaIsWhole) {
  const auto faces = sharedData("probes/cubemaps/pisaHDR"),
             map = sharedData("probes/probulator/pisa_latlong_small.hdr");
  if (!faces || !map) GTEST_SKIP() << "../shared/data/probes is not there";
  const Image whole = loadProbe(*map).latLong;
  const ImageSize size{whole.width, whole.height};
  const Image cube =
      convert(loadProbe(*faces).latLong, Mapping::LatLong, Mapping::LatLong, size, 90);
  const auto logarithm = [](float x) { return std::log(double(x) + 0.01); };
  double sum = 0;
  for (size_t i = 0; i < cube.texels.size(); ++i)
    sum += std::fabs(logarithm(cube.texels[i]) - logarithm(whole.texels[i]));
  EXPECT_LT(sum / double(cube.texels.size()), 0.1);
}

}  // namespace
}  // namespace chromeball::cube_faces_test

// SPDX-License-Identifier: Apache-2.0
// chromeball basis and chromeball relight as commands.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "relight/stage/relit_stage.h"
#include "run_command.h"
#include "small_model.h"
#include "whole_stage.h"

namespace chromeball::command_relight_test {
namespace {

using Strings = std::vector<std::string>;

class CommandRelight : public testing::Test {
 protected:
  CommandRelight() {
    writeSmallModel(folder_ / "m.gltf");
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(1, 2, 3), {0.3, 0.6, 0.6}));
  }

  std::string basis(const std::string& directions, const Strings& more = {}) const {
    const std::string path = folder_ / "s.exr";
    Strings words{"basis",   folder_ / "m.gltf", "--size",  "16x12", "--samples",
                  "16",      "--max-depth",      "1",       "-o",    path,
                  "--quiet", "--directions",     directions};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.out + result.error, "");
    return path;
  }
  CommandResult relight(const std::string& stage, const Strings& more) const {
    Strings words{"relight", stage, "--probe", folder_ / "probe.exr", "-o", folder_ / "o.exr"};
    words.insert(words.end(), more.begin(), more.end());
    CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result;
  }
  Image picture() const { return readImage(folder_ / "o.exr"); }
  void refuses(const Strings& words, const std::string& reason) const {
    Strings all = words;
    all.insert(all.end(), {"-o", folder_ / "refused.exr"});
    expectError(all, reason);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.exr"));
  }
  // A stage's picture of one element as a photograph under light of unit irradiance.
  void writePhotograph(const LightStage& stage, int element, double solidAngle,
                       const std::string& name) const {
    Image image(stage.width(), stage.height(), 3);
    for (int y = 0; y < stage.height(); ++y)
      for (int x = 0; x < stage.width(); ++x) {
        const float* e = stage.elements.at(x, y) + 3 * element;
        image.setRgb(x, y, Rgb(e[0], e[1], e[2]) / float(solidAngle));
      }
    writeImage(folder_ / name, image);
  }

  TemporaryFolder folder_;
};

// Settings of a scene file that a light stage does not have are named in one line; those that it
// has are heeded.
TEST_F(CommandRelight, StagesNameSettingsThatTheyDoNotHeed) {
  const auto stage = [&](const std::string& settings, const Strings& more = {}) {
    std::ofstream(folder_ / "s.toml") << "model = 'm.gltf'\n[render]\nsize = [16, 12]\n"
                                      << "samples = 4\n"
                                      << settings;
    Strings words{"basis", folder_ / "s.toml", "--directions", "sh:1", "-o", folder_ / "s.exr"};
    if (!more.empty()) words = {"basis", folder_ / "s.toml", "--at", "vertices", "-o", more[0]};
    words.emplace_back("--quiet");
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result.error;
  };
  const std::string all =
      "max_depth = 2\nintegrator = 'direct'\nregularize = true\ndenoise = true\n"
      "irradiance_cache = 0.2\nnoise = 3\n";
  EXPECT_TRUE(stage(all).ends_with(
      "s.toml:10: render.noise, render.regularize, render.denoise, render.integrator, "
      "render.irradiance_cache have no effect here; `chromeball render` heeds them\n"))
      << stage(all);
  EXPECT_TRUE(stage("max_diffuse_depth = 1\n[camera]\nshutter = 0.5\n")
                  .ends_with("s.toml:7: camera.shutter has no effect here; `chromeball render` "
                             "heeds it\n"));
  EXPECT_EQ(stage("integrator = 'path'\nregularize = false\nguide = 'off'\nsingle_sided = 'off'\n"
                  "[lighting]\nmis = 'off'\n[output]\nfile = 'a.exr'\n"),
            "");
  // The part of the light of a probe, which a stage does not have either.
  const std::string suns = "[lighting]\nfrom = 'suns'\n";
  for (const Strings& more : {Strings{}, Strings{folder_ / "v.glb"}}) {
    const std::string error = stage(suns, more);
    EXPECT_NE(error.find("s.toml:6: lighting.from has no effect on a "), std::string::npos)
        << error;
    EXPECT_EQ(
        stage(suns + "[[light]]\ntype = 'sun'\nirradiance = 1\ndirection = [0, 0, 1]\n", more), "");
  }
  EXPECT_TRUE(stage("max_diffuse_depth = 1\n", {folder_ / "v.glb"})
                  .ends_with("render.max_diffuse_depth has no effect here; `chromeball render` "
                             "heeds it\n"));
  // Without `samples`, a limit of noise does not mean two thousand million.
  std::ofstream(folder_ / "s.toml") << "model = 'm.gltf'\n[render]\nsize = [4, 3]\nnoise = 3\n";
  EXPECT_NE(
      runCommand({"basis", folder_ / "s.toml", "--directions", "sh:1", "-o", folder_ / "s.exr"})
          .out.find(" 256 samples"),
      std::string::npos);
}

TEST_F(CommandRelight, DomainsAgreeAndReportWhatTheyLeaveOut) {
  const std::string boxes = basis("lat-long:16x8");
  EXPECT_NE(relight(boxes, {}).out.find("relit 16 x 12 pixels from 128 elements (lat-long:16x8)"),
            std::string::npos);
  const Image pixel = picture();
  relight(boxes, {"--domain", "dct"});
  EXPECT_LT(relativeDifference(picture(), pixel), 1e-5);
  const CommandResult some = relight(boxes, {"--domain", "dct", "--keep", "10%"});
  EXPECT_NE(some.out.find("% of the stage and 0.00% of the light are zeros, error "),
            std::string::npos)
      << some.out;
  const double error = relativeDifference(picture(), pixel);
  EXPECT_GT(error, 0);
  EXPECT_NE(some.out.find(fmt::format("error {:.3g}%", 100 * error)), std::string::npos)
      << some.out << error;
  relight(boxes, {"--domain", "dct", "--keep-light", "20"});
  EXPECT_GT(relativeDifference(picture(), pixel), 0);

  const std::string cube = basis("cube:4");
  relight(cube, {});
  const Image ofCube = picture();
  relight(cube, {"--domain", "haar"});
  EXPECT_LT(relativeDifference(picture(), ofCube), 1e-5);
}

TEST_F(CommandRelight, ApproachesTheRenderAsCellsShrink) {
  const auto errorOf = [&](const std::string& directions) {
    relight(basis(directions, {"--transparent", "--half"}), {"--rotation", "70"});
    const Image staged = picture();
    EXPECT_EQ(runCommand({"render",
                          folder_ / "m.gltf",
                          "--probe",
                          folder_ / "probe.exr",
                          "--size",
                          "16x12",
                          "--samples",
                          "16",
                          "--max-depth",
                          "1",
                          "--strategy",
                          "uniform",
                          "--adaptive",
                          "off",
                          "--guide",
                          "off",
                          "--transparent",
                          "--probe-rotation",
                          "70",
                          "-o",
                          folder_ / "r.exr"})
                  .status,
              0);
    return relativeDifference(staged, readImage(folder_ / "r.exr"));
  };
  // The same samples, so that only the cells make a difference.
  const double coarse = errorOf("lat-long:8x4"), fine = errorOf("lat-long:32x16");
  EXPECT_LT(fine, coarse / 2);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(errorOf("sh:1"), 0.01);  // holds such a probe
}

TEST_F(CommandRelight, TakesPhotographs) {
  const LightStage stage = readStage(basis("icosphere:0"));
  relight(folder_ / "s.exr", {});
  const Image staged = picture();
  // The faces of an icosahedron are the Voronoi cells of their centres.
  std::vector<glm::dvec3> centres(20, glm::dvec3(0));
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x) {
      const dvec3 d = texelDirection({512, 256}, x, y);
      centres[size_t(stage.basis.cell(vec3(d)))] += d * std::sqrt(1 - d.y * d.y);
    }
  std::ofstream vectors(folder_ / "v.csv"), angles(folder_ / "a.csv");
  vectors << "file,x,y,z\n# the lamp\n\n";
  for (int i = 0; i < 20; ++i) {
    const std::string name = fmt::format("p{}.exr", i);
    writePhotograph(stage, i, 4 * kPiD / 20, name);
    const dvec3 d = glm::normalize(centres[size_t(i)]);
    vectors << fmt::format("{}, {}, {}, {}\n", name, 3 * d.x, 3 * d.y, 3 * d.z);
    angles << fmt::format("{},{},{}\r\n", name, std::atan2(-d.x, -d.z) * 180 / kPiD,
                          std::asin(d.y) * 180 / kPiD);
  }
  vectors.close(), angles.close();
  for (const char* csv : {"v.csv", "a.csv"}) {
    const CommandResult result = runCommand(
        {"relight", "--images", folder_ / ".", "--directions", folder_ / csv, "--probe",
         folder_ / "probe.exr", "--irradiance", "2", "--scale", "2", "-o", folder_ / "o.exr"});
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_LT(relativeDifference(picture(), staged), 5e-3) << csv;
  }
}

TEST_F(CommandRelight, WritesReflectanceFunctions) {
  const std::string stage = basis("lat-long:8x8");
  const CommandResult result =
      runCommand({"relight", stage, "--reflectance-function", "4,5", "-o", folder_ / "rf.exr"});
  EXPECT_EQ(result.status, 0) << result.error;
  const ImageFile function = readImageFile(folder_ / "rf.exr");
  EXPECT_EQ(function.image.width, 8);
  EXPECT_TRUE(function.metadata.contains(kMappingAttribute));  // a square map may be a ball's
  EXPECT_EQ(runCommand({"relight", basis("sh:2"), "--reflectance-function", "4,5", "-o",
                        folder_ / "rf.png"})
                .status,
            0);
  EXPECT_EQ(readImage(folder_ / "rf.png").width, 64);
}

TEST_F(CommandRelight, RefusesBadStages) {
  const std::string probe = folder_ / "probe.exr", stage = folder_ / "bad.exr";
  const auto refusesStage = [&](const std::string& reason) {
    refuses({"relight", stage, "--probe", probe}, reason);
  };
  refusesStage("bad.exr");  // there is none
  writeImage(stage, Image(4, 4, 3));
  refusesStage("is not a light stage");
  const auto write = [&](const std::string& basis) {
    writeImage(stage,
               OutputImage{{{"", "RGB", Image(4, 4, 3)}, {"element.0000", "RGB", Image(4, 4, 3)}},
                           {{"basis", basis}},
                           {},
                           {}});
  };
  write("lat-long:2x1");
  refusesStage("lacks elements of its basis lat-long:2x1, which has 2");
  for (const char* basis : {"lat-long:99999x99999", "cube:-1", "nearest"}) {
    write(basis);
    refusesStage("bad.exr: `");
  }
  write("lat-long:1x1");
  EXPECT_EQ(relight(stage, {}).status, 0);
  LightStage invalid{DirectionBasis("lat-long:2x1", "test"), Image(4, 4, 6), {}};
  invalid.elements.at(3, 2)[5] = NAN;
  writeStage(stage, invalid, Image(4, 4, 3), false);
  refusesStage("pixel 3, 2 has values that are not finite");
  invalid.elements.at(3, 2)[5] = INFINITY;
  writeStage(stage, invalid, Image(4, 4, 3), true);
  refusesStage("pixel 3, 2 has values that are not finite");
  std::ofstream(stage) << "no picture";
  refusesStage("it is not an EXR");
}

TEST_F(CommandRelight, RefusesBadOptions) {
  const std::string stage = basis("lat-long:4x4"), probe = folder_ / "probe.exr";
  const auto refusesOptions = [&](const Strings& more, const std::string& reason) {
    Strings words{"relight", stage, "--probe", probe};
    words.insert(words.end(), more.begin(), more.end());
    refuses(words, reason);
  };
  refusesOptions({"--domain", "haar"}, "domain haar: needs cube:N with a power of two");
  refusesOptions({"--domain", "dct"}, "domain dct: needs lat-long:WxH with multiples of 8");
  refusesOptions({"--domain", "sh"}, "domain sh: needs spherical harmonics");
  refusesOptions({"--domain", "wavelet"}, "domain: `wavelet` is unknown");
  for (const char* keep : {"0", "0%", "101%", "-5", "many", "", "%"}) {
    refusesOptions({"--keep", keep}, "--keep: ");
    refusesOptions({"--keep-light", keep}, "--keep-light: ");
  }
  refusesOptions({"--probe", probe}, "--probe: give one");
  refusesOptions({"--reflectance-function", "1,1"}, "give one of the two");
  refusesOptions({"--images", "."}, "are in place of a light stage");
  refusesOptions({"--probe-scale", "-1"}, "--probe-scale");
  refusesOptions({"--probe-rotation", "x"}, "--probe-rotation");
  refusesOptions({"--exposure", "nan"}, "--exposure: must be a finite number");
  refusesOptions({"--exposure", "1"}, "--exposure: is for a .png");
  refusesOptions({"--tonemap", "aces"}, "--tonemap: is for a .png");
  refusesOptions({"--irradiance", "2"}, "--irradiance: is for --images");
  for (const Strings& option : {Strings{"--keep", "10"},
                                {"--keep-light", "10"},
                                {"--probe-scale", "2"},
                                {"--probe-rotation", "20"},
                                {"--domain", "pixel"}})
    refuses({"relight", stage, "--reflectance-function", "1,1", option[0], option[1]},
            option[0] + ": has no effect with --reflectance-function");
  refusesOptions({"--preview"}, "--output: has no effect with --preview");
  expectError({"relight", stage, "--probe", probe, "--preview=99999"}, "is not a port");
  expectError({"relight", stage, "--probe", probe}, "--output: needs a name");
  expectError({"relight", stage, "--probe", probe, "-o", stage}, "s.exr");
  expectError({"relight", stage, "--probe", probe, "-o", folder_ / "x.txt"}, "image format");
  refuses({"relight", stage}, "give one of the two");
  refuses({"relight", "--probe", probe}, "STAGE: give a light stage");
  for (const char* pixel : {"16,0", "0,12", "-1,0", "1.5,2", "1", "a,b", "1,2,3"})
    refuses({"relight", stage, "--reflectance-function", pixel}, "--reflectance-function: ");
  const std::string harmonics = basis("sh:1");
  refuses({"relight", harmonics, "--probe", probe, "--domain", "pixel"}, "needs cells");
}

TEST_F(CommandRelight, RefusesBadPhotographs) {
  writeImage(folder_ / "a.exr", Image(4, 4, 3));
  writeImage(folder_ / "b.exr", Image(4, 4, 3));
  writeImage(folder_ / "wide.exr", Image(5, 4, 3));
  Image invalid(4, 4, 3);
  invalid.setRgb(1, 2, Rgb(INFINITY));
  writeImage(folder_ / "invalid.exr", invalid);
  const auto refusesList = [&](const std::string& text, const std::string& reason) {
    std::ofstream(folder_ / "d.csv") << text;
    refuses({"relight", "--images", folder_ / ".", "--directions", folder_ / "d.csv", "--probe",
             folder_ / "probe.exr"},
            reason);
  };
  refusesList("", "d.csv: names no photographs");
  refusesList("file,x,y,z\n", "d.csv: names no photographs");
  refusesList("a.exr,0,1,0\nnone.exr,1,0,0\n", "none.exr");
  refusesList("a.exr,0,1,0\nb.exr,0,0,0\n", "d.csv:2: the direction has no length");
  refusesList("a.exr,0,1,0\nb.exr,0,2,0\n", "d.csv:2: has the direction of `a.exr`");
  refusesList("a.exr,0,1,0\na.exr,0,0,1\n", "d.csv:2: `a.exr` is on line 1 too");
  refusesList("a.exr,0,1,0\nb.exr,90,10\n", "d.csv:2: has 2 numbers, and the lines before 3");
  refusesList("a.exr,0,91\n", "d.csv:1: the elevation");
  refusesList("a.exr,0,0,1.O\nb.exr,0,1,0\n", "d.csv:1: should be FILE,X,Y,Z");
  refusesList("a.exr,nan,0,1\nb.exr,0,1,0\n", "d.csv:1: should be FILE,X,Y,Z");
  refusesList(
      "\xef\xbb\xbf"
      "none.exr,0,0,1\n",
      "/none.exr: no such file");
  refusesList("\"n, 1\", 0,0,\"1\"\n", "/n, 1: no such file");  // as spreadsheets quote
  refusesList("\"the \"\"n\"\"\",0,0,1\n", "/the \"n\": no such file");
  refusesList("n\".exr,0,0,1\n", "/n\".exr: no such file");
  refusesList("a.exr,0,1,0\nb.exr,1,x,0\n", "d.csv:2: should be FILE,X,Y,Z");
  refusesList("a.exr,0,1,0\nb.exr,1,nan,0\n", "d.csv:2: should be");
  refusesList("a.exr,0,1,0\nb.exr\n", "d.csv:2: should be");
  refusesList("a.exr,0,1,0\n,0,0,1\n", "d.csv:2: should be");
  refusesList("a.exr,0,1,0\nwide.exr,0,0,1\n", "wide.exr: has 5 x 4 pixels; a.exr has 4 x 4");
  refusesList("a.exr,0,1,0\ninvalid.exr,0,0,1\n", "invalid.exr: pixel 1, 2 has values");
  std::ofstream(folder_ / "d.csv") << "a.exr,0,1,0\n";
  expectError({"relight", "--images", folder_ / ".", "--directions", folder_ / "d.csv", "--probe",
               folder_ / "probe.exr", "-o", folder_ / "a.exr"},
              "would overwrite");
  const Strings good{"relight",
                     "--images",
                     folder_ / ".",
                     "--directions",
                     folder_ / "d.csv",
                     "--probe",
                     folder_ / "probe.exr",
                     "--irradiance",
                     "0"};
  refuses(good, "--irradiance: should be");
  refuses({"relight", "--images", folder_ / ".", "--probe", folder_ / "probe.exr"}, "go together");
  refuses({"relight", "--images", folder_ / ".", "--directions", folder_ / "no.csv", "--probe",
           folder_ / "probe.exr"},
          "no.csv");
}

TEST_F(CommandRelight, BasisRefusesWhatItCannotRender) {
  const std::string model = folder_ / "m.gltf";
  refuses({"basis", model, "--directions", "disc:3"}, "--directions: `disc:3` is not lat-long:WxH");
  refuses({"basis", model, "--directions", "cube:16", "--size", "5000x4000"},
          "--directions: 5000 x 4000 pixels with 1536 elements are");
  refuses({"basis", model, "--frames", "1:3"}, "unknown option `--frames`");
  refuses({"basis", model, "--probe", folder_ / "probe.exr"}, "unknown option `--probe`");
  refuses({"basis", folder_ / "none.gltf"}, "none.gltf");
  expectError({"basis", model, "-o", folder_ / "s.png"}, ".exr");
  std::ofstream(folder_ / "c.toml")
      << "model = \"m.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
         "[composite]\nplate = \"probe.exr\"\nlocal_scene = [\"plate\"]\n";
  refuses({"basis", folder_ / "c.toml"}, "a composite has no light stage");
  std::ofstream(folder_ / "r.toml") << "model = \"m.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
                                       "[surroundings]\nshape = \"sphere\"\nradius = 10\n";
  refuses({"basis", folder_ / "r.toml"}, "[surroundings]");
}

// A probe in the scene file has no part in it; lamps do.
TEST_F(CommandRelight, LampsOfTheSceneAreAdded) {
  std::ofstream(folder_ / "l.toml") << "model = \"m.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
                                       "[[light]]\ntype = \"sun\"\ndirection = [0, 0, 1]\n"
                                       "irradiance = [3, 2, 1]\nangle = 0.5\n";
  const Strings same{"--size", "16x12", "--samples", "16", "--max-depth", "1"};
  Strings words{"basis", folder_ / "l.toml", "--directions", "lat-long:8x8",
                "-o",    folder_ / "s.exr"};
  words.insert(words.end(), same.begin(), same.end());
  const CommandResult result = runCommand(words);
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("and the scene's own light"), std::string::npos) << result.out;
  writeImage(folder_ / "probe.exr", constantProbe({8, 4}, Rgb(0.5f)));
  relight(folder_ / "s.exr", {});
  words = {"render", folder_ / "l.toml", "--strategy", "uniform", "--adaptive",
           "off",    "--guide",          "off",        "-o",      folder_ / "r.exr"};
  words.insert(words.end(), same.begin(), same.end());
  ASSERT_EQ(runCommand(words).status, 0);
  EXPECT_LT(relativeDifference(picture(), readImage(folder_ / "r.exr")), 1e-5);
}

}  // namespace
}  // namespace chromeball::command_relight_test

// SPDX-License-Identifier: Apache-2.0
// `chromeball camera solve`, and cameras of files in renders.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "exif_block.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "photographs_of_points.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/solve/observations.h"
#include "shared_data.h"

namespace chromeball::command_camera_test {
namespace {

// A model of one triangle, a grey photograph, and the points that its camera sees.
class CommandCamera : public testing::Test {
 protected:
  CommandCamera() {
    addTriangle(model_);
    model_.root["scenes"] = {{{"nodes", {0}}}};
    model_.save();
    Image grey(truth_.size.width, truth_.size.height, 3);
    for (float& texel : grey.texels) texel = 0.2f;
    writeImage(path("plate.png"), grey);
  }

  std::string path(const std::string& name) const { return (model_.folder() / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  static std::string csv(const std::vector<ObservedPoint>& points) {
    std::string text = "name,x,y,z,px,py\n";
    for (const ObservedPoint& p : points)
      text += fmt::format("{},{},{},{},{},{}\n", p.name, p.position.x, p.position.y, p.position.z,
                          p.pixel.x, p.pixel.y);
    return text;
  }

  std::vector<std::string> solve(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"camera",          "solve", path("model.gltf"),
                                          path("plate.png"), "-o",    path("camera.toml")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void expectPointsError(const std::string& text, const std::string& reason,
                         std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--points", write("bad.csv", text)});
    expectError(solve(more), reason);
    EXPECT_FALSE(std::filesystem::exists(path("camera.toml")));
  }
  std::string render(const std::string& scene, const std::string& out,
                     std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "render", scene,       "-o", path(out), "--size",
        "64x48",  "--samples", "16", "--probe", path("probe.hdr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult r = runCommand(arguments);
    EXPECT_EQ(r.status, 0) << r.error;
    return path(out);
  }

  const SolvedCamera truth_ = photographFrom({1, 1.7, 3}, {0.3, 0.3, 0}, 50, -0.06, {400, 300});
  GltfWriter model_;
};

class SlowCommandCamera : public CommandCamera {};

TEST_F(SlowCommandCamera, FindsTheCameraThatAnImageIsRenderedFrom) {
  std::mt19937 random(1);
  const auto points = observe(truth_, 14, {1.2, 0.8, 1.2}, 0, random);
  const std::string list = write("points.csv", csv(points));
  const CommandResult r =
      runCommand(solve({"--points", list, "--distortion", "--preview", path("preview.png")}));
  ASSERT_EQ(r.status, 0) << r.error;
  for (const char* word : {"points      14, RMS", "worst `p", "position    1 1.7 3 +- ",
                           "rotation    +- ", "fov         50 +- ", "k1          -0.06 +- "})
    EXPECT_NE(r.out.find(word), std::string::npos) << word << " in " << r.out;
  EXPECT_EQ(r.error, "");

  // The camera's file gives the same image as the same numbers in a scene file, as --camera-file
  // and as `file`.
  writeImage(path("probe.hdr"), overcastProbe({16, 8}, Rgb(1), 0.3));
  const dvec3 target = truth_.position - truth_.axes[2], up = truth_.axes[1];
  const std::string inScene =
      write("inline.toml",
            fmt::format(
                "model = \"model.gltf\"\n[camera]\nposition = [1, 1.7, 3]\nlook_at = [{}, {}, {}]\n"
                "up = [{}, {}, {}]\nfov = 50\ndistortion = -0.06\n",
                target.x, target.y, target.z, up.x, up.y, up.z));
  const std::string byFile =
      write("file.toml", "model = \"model.gltf\"\n[camera]\nfile = \"camera.toml\"\n");
  const Image expected = readImage(render(inScene, "inline.exr"));
  for (const std::string& file :
       {render(byFile, "file.exr"),
        render(path("model.gltf"), "option.exr", {"--camera-file", path("camera.toml")})}) {
    const Image image = readImage(file);
    double difference = 0;
    for (size_t i = 0; i < image.texels.size(); ++i)
      difference += std::abs(image.texels[i] - expected.texels[i]);
    EXPECT_LT(difference / double(image.texels.size()), 1e-4);
  }
  const Image pinhole = readImage(render(
      write("pinhole.toml", fileContents(inScene).substr(0, fileContents(inScene).find("distor"))),
      "pinhole.exr"));
  EXPECT_NE(pinhole.texels, expected.texels);

  // The preview has circles of yellow and crosses of red at the points.
  const Image preview = readImage(path("preview.png"));
  ASSERT_EQ(preview.width, 400);
  int red = 0, green = 0;
  for (int y = 0; y < preview.height; ++y)
    for (int x = 0; x < preview.width; ++x) {
      const Rgb c = preview.rgb(x, y);
      red += c.x > 0.9f && c.y < 0.2f;
      green += c.y > 0.9f && c.x < 0.3f;
    }
  EXPECT_GT(red, 14 * 4);
  EXPECT_GT(green, 100);
}

TEST_F(CommandCamera, PrintsJson) {
  std::mt19937 random(2);
  const auto points = observe(truth_, 9, {1.2, 0.8, 1.2}, 0.5, random);
  const CommandResult r =
      runCommand(solve({"--points", write("points.csv", csv(points)), "--fov", "50", "--json"}));
  ASSERT_EQ(r.status, 0) << r.error;
  const auto json = parseJson(r.out);
  EXPECT_EQ(json["method"], "points");
  EXPECT_NEAR(json["fov"], 50, 1e-9);
  EXPECT_GT(json["rms"], 0.1);
  EXPECT_EQ(json["distances"].size(), 9u);
  EXPECT_GT(json["errors"]["position"][0], 0);
  EXPECT_FALSE(json["errors"].contains("fov"));
  EXPECT_TRUE(fileContents(path("camera.toml")).find("# points") != std::string::npos);
}

TEST_F(CommandCamera, LinesAndFspyGiveCamerasToo) {
  const SolvedCamera straight = photographFrom({1, 1.7, 3}, {0.3, 0.3, 0}, 50, 0, {400, 300});
  std::string lines = "# walls\r\naxis,x1,y1,x2,y2,metres\r\n";
  const auto add = [&](const char* axis, const dvec3& from, const dvec3& to, const char* metres) {
    const dvec2 a = pixelOf(straight, from).value(), b = pixelOf(straight, to).value();
    lines += fmt::format("{},{},{},{},{},{}\r\n", axis, a.x, a.y, b.x, b.y, metres);
  };
  add("x", {0, 0, 0}, {0.5, 0, 0}, "0.5");
  add("x", {0, 0.5, 0.2}, {0.5, 0.5, 0.2}, "");
  add("z", {0, 0, 0}, {0, 0, 0.5}, "");
  add("z", {0.6, 0.3, 0}, {0.6, 0.3, 0.5}, "");
  const CommandResult r = runCommand(solve({"--lines", write("lines.csv", lines)}));
  ASSERT_EQ(r.status, 0) << r.error;
  EXPECT_NE(r.out.find("position    1 1.7 3 m"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("fov         50 +- unknown degrees"), std::string::npos) << r.out;

  const std::string json =
      write("fspy.json", R"({"principalPoint":{"x":0,"y":0},"cameraTransform":{"rows":
[[1,0,0,0.2],[0,0,-1,-4],[0,1,0,1.5],[0,0,0,1]]},
"verticalFieldOfView":1,"imageWidth":800,"imageHeight":600})");
  const CommandResult f = runCommand(solve({"--fspy", json, "--up", "z"}));
  ASSERT_EQ(f.status, 0) << f.error;
  EXPECT_NE(f.out.find("position    0.2 1.5 4 m"), std::string::npos) << f.out;
  EXPECT_NE(f.out.find("looks along 0.00000 0.00000 -1.00000"), std::string::npos) << f.out;
  const std::string text = fileContents(json);
  write("fspy.json", text.substr(0, text.find("600")) + "900}");
  expectError(solve({"--fspy", json}), "is of a photograph of 800x900 pixels, and");
}

TEST_F(CommandCamera, RefusesBadLists) {
  const std::string head = "name,x,y,z,px,py\n";
  expectPointsError(head, "bad.csv: 0 points are too few for a camera and its field of view");
  expectPointsError("", "bad.csv: 0 points are too few");
  expectPointsError(head + "a,0,0,0,nan,5\n",
                    "bad.csv:2: `px` is `nan`; it should be a finite number");
  expectPointsError(head + "a,0,inf,0,2,5\n", "bad.csv:2: `y` is `inf`");
  expectPointsError(head + "a,0,1e999,0,2,5\n", "bad.csv:2: `y` is `1e999`");
  expectPointsError(head + "a,0,0,0,1e160,5\n", "bad.csv:2: `px` is `1e160`; it should be between");
  expectPointsError(head + "a,0,,0,2,5\n", "bad.csv:2: `y` is ``");
  expectPointsError(head + "\na,0,1,0,2\n",
                    "bad.csv:3: has the columns `a,0,1,0,2`; they should be name,x,y,z,px,py");
  expectPointsError("name;x;y;z;px;py\na;0;1;0;2;3\n", "bad.csv:1: has the columns");
  expectPointsError("name,px,py,x,y,z\na,0,1,0,2,3\n", "bad.csv:1: has the columns");
  expectPointsError(head + "a,0,1,0,2,3\na,0,2,0,2,4\n", "bad.csv:3: the name `a` is also that of");
  expectPointsError(head + "a\x1b[31m,0,1,0,2,x\n", "`py` is `x`");
  std::string many = head;
  for (int i = 0; i < 1001; ++i) many += fmt::format("p{},0,1,0,2,3\n", i);
  expectPointsError(many, "bad.csv: has more than 1000 rows");
  expectPointsError(std::string(2 << 20, 'x'), "bad.csv: is too long");
  std::string line = head;
  for (int i = 0; i < 8; ++i) line += fmt::format("p{0},{0},{0},{0},{1},{1}\n", i, 10 * i);
  expectPointsError(line, "bad.csv: the points lie on a line");
  expectError(solve({"--points", path("none.csv")}), "none.csv");
  expectError(solve({"--points", path("")}), "");
  expectError(solve({"--lines", write("l.csv", "w,1,2,3,4\n")}),
              "`axis` is `w`; it should be x, y or z");
  expectError(solve({"--lines", write("l.csv", "x,1,2,1,2\n")}), "the line's ends are the same");
  expectError(solve({"--lines", write("l.csv", "x,1,2,3,4,-1\n")}), "`metres` should be above 0");
}

TEST_F(CommandCamera, RefusesBadOptions) {
  const std::string list = write("points.csv", "a,0,0,0,1,1\n");
  expectError(solve({}), "give one of --points, --lines and --fspy");
  expectError(solve({"--points", list, "--lines", list}), "give one of");
  expectError(solve({"--points", list, "--height", "2"}), "--height: is for --lines");
  expectError(solve({"--points", list, "--origin", "2,3"}), "--origin: is for --lines");
  expectError(solve({"--lines", list, "--distortion"}), "--distortion: is for --points");
  expectError(solve({"--points", list, "--up", "z"}), "--up: is for --fspy");
  expectError(solve({"--fspy", list, "--fov", "40"}), "--fov: is for --points and --lines");
  expectError(solve({"--fspy", list, "--up", "x"}), "--up: `x` should be y or z");
  expectError(solve({"--points", list, "--fov", "180"}), "--fov: 180 should be 0.01 to 179");
  expectError(solve({"--points", list, "--focal35", "-1"}), "--focal35: -1 should be");
  expectError(solve({"--points", list, "--fov", "40", "--focal35", "28"}),
              "--fov: excludes --focal35");
  expectError(solve({"--lines", list, "--height", "0"}), "--height: 0 should be");
  expectError(solve({"--points", list, "--principal-point", "0.5"}), "--principal-point");
  expectError({"camera", "solve", path("model.gltf"), path("plate.png"), "--points", list, "-o",
               path("camera.txt")},
              ".toml");
  expectError({"camera", "solve", path("none.glb"), path("plate.png"), "--points", list, "-o",
               path("c.toml")},
              "none.glb");
  expectError({"camera", "solve", path("model.gltf"), path("none.png"), "--points", list, "-o",
               path("c.toml")},
              "none.png");
  expectError(solve({"--points", list, "--preview", path("plate.png")}), "plate.png");
}

TEST_F(CommandCamera, CamerasInFilesAreChecked) {
  writeImage(path("probe.hdr"), overcastProbe({16, 8}, Rgb(1), 0.3));
  const std::string place = "position = [0, 0, 3]\nlook_at = [0, 0, 0]\n";
  const auto refuse = [&](const std::string& camera, const std::string& reason,
                          const std::string& file =
                              "[camera]\nposition = [0, 0, 3]\n"
                              "look_at = [0, 0, 0]\n") {
    write("camera.toml", file);
    const std::string scene = write("scene.toml", "model = \"model.gltf\"\n[camera]\n" + camera);
    expectError({"render", scene, "--probe", path("probe.hdr"), "-o", path("x.exr")}, reason);
  };
  const std::string byFile = "file = \"camera.toml\"\n";
  refuse("file = \"none.toml\"", "no such file");
  refuse(byFile + "up = [0, 1, 0]", "[camera] has a `file`; it cannot have `up` too");
  refuse(byFile + "distortion = 0.1", "it cannot have `distortion` too");
  refuse(byFile, "camera.toml: has no [camera] with `position` and `look_at`", "");
  refuse(byFile, "camera.toml:2: a camera's own file has `position`", "[camera]\nfile = \"a\"\n");
  refuse(byFile, "and no `shutter`", "[camera]\nshutter = 24\n");
  refuse(byFile, "camera.toml:2: unknown key `fovv`", "[camera]\nfovv = 3\n");
  refuse(byFile, "camera.toml:1: unknown key `probe`", "probe = 3\n");
  refuse(byFile, "camera.toml:1: not valid TOML", "[camera");
  refuse(place + "principal_point = 0.5", "`principal_point` must be two numbers");
  refuse(place + "principal_point = [0.5, 99]", "`principal_point` must be");
  refuse(place + "distortion = \"barrel\"", "`distortion` must be a number, k1, or two, [k1, k2]");
  refuse(place + "distortion = [0.1, 0.2, 0.3]", "`distortion` must be");
  refuse(place + "distortion = nan", "`distortion` must be");
  refuse(place + "fov = 90\ndistortion = -0.3",
         "scene.toml:6: the image folds back inside the frame");
  refuse(place + "orthographic = 2\ndistortion = 0.1", "an orthographic camera has no lens");
  expectError({"render", path("model.gltf"), "--probe", path("probe.hdr"), "-o", path("x.exr"),
               "--camera-file", path("camera.toml"), "--camera", "A"},
              "--camera-file: excludes --camera");
}

TEST_F(CommandCamera, OfAFileReplacesTheOpticsOfTheScenesCameraWithAWord) {
  writeImage(path("probe.hdr"), overcastProbe({16, 8}, Rgb(1), 0.3));
  const std::string camera =
      write("camera.toml", "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n");
  const auto errorOf = [&](const std::string& optics) {
    const std::string scene = write("scene.toml", "model = \"model.gltf\"\n" + optics);
    const CommandResult r =
        runCommand({"render", scene, "--probe", path("probe.hdr"), "-o", path("x.exr"),
                    "--camera-file", camera, "--size", "16x16", "--samples", "1"});
    EXPECT_EQ(r.status, 0) << r.error;
    return r.error;
  };
  EXPECT_EQ(errorOf("").find("distortion"), std::string::npos);
  EXPECT_NE(errorOf("[camera]\ndistortion = 0.1\n")
                .find("scene.toml:3: `principal_point` and `distortion` go with the scene's own"),
            std::string::npos);
}

// The files of a scene file's models are inputs too, also through links.
TEST_F(CommandCamera, DoesNotOverwriteTheModelsOfAScene) {
  std::mt19937 random(2);
  const std::string list = write("points.csv", csv(observe(truth_, 8, {1, 1, 1}, 0, random)));
  const std::string model = fileContents(path("model.gltf"));
  std::filesystem::create_symlink(path("model.gltf"), path("link.png"));
  expectError(
      {"camera", "solve", write("scene.toml", "model = \"model.gltf\"\n"), path("plate.png"),
       "--points", list, "-o", path("c.toml"), "--preview", path("link.png")},
      "would overwrite the input");
  EXPECT_EQ(fileContents(path("model.gltf")), model);
}

TEST_F(CommandCamera, ExifTellsTheFocalLengthWhereItIsNeeded) {
  const std::string jpeg = fileContents(std::string(kSourceDir) + "/tests/fuzz/seeds/image/a.jpg");
  std::ofstream(path("photo.jpg"), std::ios::binary)
      << withExif(jpeg, exifBlock({{0xa405, 28, 0}}));
  const Image photo = readImage(path("photo.jpg"));
  SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0, 0}, 50, 0, {photo.width, photo.height});
  truth.focalLength = focalLengthOf35mm(truth.size, 28);
  std::mt19937 random(3);
  const std::string list = write("points.csv", csv(observe(truth, 5, {1, 1, 1}, 0, random)));
  const CommandResult r = runCommand({"camera", "solve", path("model.gltf"), path("photo.jpg"),
                                      "--points", list, "-o", path("camera.toml")});
  ASSERT_EQ(r.status, 0) << r.error;
  EXPECT_NE(r.error.find("its EXIF tells a focal length of 28 mm"), std::string::npos) << r.error;
  EXPECT_NE(r.out.find("28 mm on 35 mm film (given)"), std::string::npos) << r.out;
}

}  // namespace
}  // namespace chromeball::command_camera_test

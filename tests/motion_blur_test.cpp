// SPDX-License-Identifier: Apache-2.0
// Motion blur: an image with an open shutter is the mean over the shutter's time.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "math/sampler.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/camera.h"
#include "session/render_loaded.h"
#include "shared_data.h"
#include "temporary_folder.h"
#include "test_probes.h"

namespace chromeball::motion_blur_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

const json kShining = {{"emissiveFactor", {1, 1, 1}},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
                       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};

// The ways to move the square, or the view of it, by one metre along +X in one second.
enum class Mover { Node, SharedNode, Morph, Skin, Camera };

// A square of side 1 m with the radiance 1, from (-1, -0.5) to (0, 0.5) at time 0, before black; an
// orthographic camera that looks along -Z and sees 4 m x 3 m.
class MovingSquare {
 public:
  explicit MovingSquare(Mover mover) {
    w_.add("materials", kShining);
    w_.root["extensionsUsed"] = {"KHR_materials_specular"};
    json primitive = {{"material", 0},
                      {"indices", w_.indices({0, 1, 2, 0, 2, 3})},
                      {"attributes",
                       {{"POSITION", w_.vec3s({-1, -.5, 0, 0, -.5, 0, 0, .5, 0,  //
                                               -1, .5, 0})}}}};
    if (mover == Mover::Morph)
      primitive["targets"] = {{{"POSITION", w_.vec3s({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    if (mover == Mover::Skin) {
      const std::vector<uint8_t> joints(16, 0);
      std::vector<float> weights;
      for (int i = 0; i < 4; ++i) weights.insert(weights.end(), {1, 0, 0, 0});
      primitive["attributes"]["JOINTS_0"] = w_.accessor(w_.view(joints), kUByte, "VEC4", 4);
      primitive["attributes"]["WEIGHTS_0"] = w_.accessor(w_.view(weights), kFloat, "VEC4", 4);
    }
    const int mesh = w_.mesh(primitive);
    if (mover == Mover::Morph) w_.root["meshes"][size_t(mesh)]["weights"] = {0};
    const int square = w_.add("nodes", {{"mesh", mesh}});
    w_.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 2}, {"ymag", 1.5}, {"znear", 0}, {"zfar", 10}}}});
    const int camera = w_.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
    int moved = square;
    if (mover == Mover::SharedNode)  // far below the image
      w_.add("nodes", {{"mesh", mesh}, {"translation", {0, -20, 0}}});
    if (mover == Mover::Skin) {
      moved = w_.add("nodes", {{"name", "joint"}});
      w_.add("skins", {{"joints", {moved}}});
      w_.root["nodes"][size_t(square)]["skin"] = 0;
    }
    if (mover == Mover::Camera) moved = camera;
    const std::vector<float> times{0, 10}, weights{0, 10};
    const bool morphs = mover == Mover::Morph;
    const float z = mover == Mover::Camera ? 5 : 0, way = mover == Mover::Camera ? -10 : 10;
    const int output = morphs ? w_.accessor(w_.view(weights), kFloat, "SCALAR", 2)
                              : w_.vec3s({0, 0, z, way, 0, z});
    w_.add("animations",
           {{"channels",
             {{{"sampler", 0},
               {"target", {{"node", moved}, {"path", morphs ? "weights" : "translation"}}}}}},
            {"samplers",
             {{{"input", w_.accessor(w_.view(times), kFloat, "SCALAR", 2)}, {"output", output}}}}});
    path_ = w_.save();
  }

  const std::string& path() const { return path_; }

 private:
  GltfWriter w_;
  std::string path_;
};

Settings settingsOf(double time, std::optional<double> shutter, uint64_t seed, uint64_t samples,
                    ImageSize size) {
  Settings s;
  s.set("model.time", time);
  if (shutter) s.set("fps", 1.0), s.set("camera.shutter", *shutter);
  s.set("render.size", size);
  s.set("render.samples", samples);
  s.set("render.seed", seed);
  s.set("render.adaptive", std::string("off"));
  return s;
}

Image rendered(const std::string& path, const Settings& settings) {
  RenderDescription description = planRender(openScene(path), settings);
  const LoadedScene loaded = loadScene(description);
  return renderLoaded(loaded).color();
}

// The square moves by its width w: at x, the fraction of the time for which it covers x rises from
// 0 to 1 over the first width and falls over the second.
TEST(SlowMotionBlur, AMovingSquareIsATriangle) {
  constexpr int kWidth = 64, kHeight = 48, kSamples = 256;
  constexpr double z = 4.7;  // 320 tests at a significance of 0.1% for all (Sidak)
  for (const Mover mover :
       {Mover::Node, Mover::SharedNode, Mover::Morph, Mover::Skin, Mover::Camera}) {
    SCOPED_TRACE(int(mover));
    const MovingSquare square(mover);
    const Image image = rendered(square.path(), settingsOf(0, 1.0, 5, kSamples, {kWidth, kHeight}));
    for (int x = 0; x < kWidth; ++x) {
      const auto coverage = [](double at) { return std::max(0.0, 1 - std::fabs(at)); };
      double expected = 0;  // mean over the pixel
      for (int i = 0; i < 100; ++i) expected += coverage(-2 + 4 * (x + (i + 0.5) / 100) / kWidth);
      expected /= 100;
      double sum = 0;  // of the rows that the square covers whole
      for (int y = kHeight / 3 + 1; y < 2 * kHeight / 3 - 1; ++y) sum += image.rgb(x, y).x;
      const int rows = kHeight / 3 - 2;
      const double sigma = std::sqrt(expected * (1 - expected) / (double(rows) * kSamples));
      EXPECT_NEAR(sum / rows, expected, z * sigma + 1e-6) << x;
    }
    EXPECT_EQ(image.rgb(kWidth / 2, 2), Rgb(0));
  }
}

// Before its first key the animation stands still; then it moves by twice the square's width.
TEST(SlowMotionBlur, AFastSquareIsATrapezoid) {
  constexpr int kWidth = 64, kSamples = 1024;
  const MovingSquare square(Mover::Node);
  Settings settings = settingsOf(-0.5, 2.5, 1, kSamples, {kWidth, 48});
  settings.set("camera.shutter_steps", uint64_t(5));  // so that a key is at time 0
  const Image image = rendered(square.path(), settings);
  for (const double at : {-0.25, 0.0, 0.2, 0.7}) {
    const int x = int((at + 2) / 4 * kWidth);
    double sum = 0;
    for (int y = 20; y < 28; ++y) sum += image.rgb(x, y).x;
    const double middle = -2 + 4 * (x + 0.5) / kWidth;  // of the pixel
    const double seconds = middle < 0 ? 0.5 + (1 + middle) : 1;
    EXPECT_NEAR(sum / 8, seconds / 2.5, 0.02) << at;
  }
}

// Over black, the light that reaches the image does not change while the source moves.
TEST(SlowMotionBlur, KeepsTheEnergyOfAHighlight) {
  GltfWriter w;
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
  std::vector<float> positions;
  std::vector<uint16_t> indices;
  constexpr int kColumns = 96, kRows = 48;
  for (int r = 0; r <= kRows; ++r)
    for (int c = 0; c <= kColumns; ++c) {
      const double theta = kPiD * r / kRows, phi = 2 * kPiD * c / kColumns;
      positions.insert(positions.end(),
                       {float(0.5 * std::sin(theta) * std::sin(phi)), float(0.5 * std::cos(theta)),
                        float(0.5 * std::sin(theta) * std::cos(phi))});
    }
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const uint16_t a = uint16_t(r * (kColumns + 1) + c), b = uint16_t(a + kColumns + 1);
      indices.insert(indices.end(), {a, b, uint16_t(a + 1), uint16_t(a + 1), b, uint16_t(b + 1)});
    }
  std::vector<float> normals = positions;
  for (float& x : normals) x *= 2;
  const int mesh =
      w.mesh({{"material", 0},
              {"indices", w.indices(indices)},
              {"attributes", {{"POSITION", w.vec3s(positions)}, {"NORMAL", w.vec3s(normals)}}}});
  const int ball = w.add("nodes", {{"mesh", mesh}, {"translation", {1, 0, 0}}});
  const int arm = w.add("nodes", {{"children", {ball}}});
  const int eye = w.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
  w.root["scenes"] = {{{"nodes", {arm, eye}}}};
  w.root["scene"] = 0;
  w.add("cameras", {{"type", "orthographic"},
                    {"orthographic", {{"xmag", 2}, {"ymag", 1.5}, {"znear", 0}, {"zfar", 10}}}});
  // The ball goes round the camera's axis, by a quarter of a turn in a second.
  const std::vector<float> times{0, 1}, turns{0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f};
  w.add("animations",
        {{"channels", {{{"sampler", 0}, {"target", {{"node", arm}, {"path", "rotation"}}}}}},
         {"samplers",
          {{{"input", w.accessor(w.view(times), kFloat, "SCALAR", 2)},
            {"output", w.accessor(w.view(turns), kFloat, "VEC4", 2)}}}}});
  w.save();
  const std::string scene = (w.folder() / "scene.toml").string();
  std::ofstream(scene) << "model = \"model.gltf\"\n[[light]]\ntype = \"sun\"\n"
                          "direction = [0.3, -0.5, -1]\nangle = 40\nradiance = 100\n";
  const auto total = [&](std::optional<double> shutter, uint64_t seed) {
    const Image image = rendered(scene, settingsOf(0, shutter, seed, 256, {64, 48}));
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.rgb(x, y).x;
    return sum;
  };
  double still = 0, moving = 0, still2 = 0, moving2 = 0;
  constexpr int kRuns = 8;
  for (int i = 0; i < kRuns; ++i) {
    const double a = total({}, uint64_t(i)), b = total(1.0, uint64_t(100 + i));
    still += a / kRuns, still2 += a * a / kRuns, moving += b / kRuns, moving2 += b * b / kRuns;
  }
  const double error =
      std::sqrt((still2 - still * still + moving2 - moving * moving) / (kRuns - 1));
  EXPECT_GT(still, 100);
  EXPECT_NEAR(moving, still, 4 * error);
  EXPECT_LT(error, 0.02 * still) << "the test must be able to fail";
}

// The mean of images at a random time in each of kTimes parts of the shutter's interval: its
// expectation equals an open shutter's, whatever moves.
Image meanOfStills(const std::string& scene, double shutter, uint64_t seed, uint64_t samples,
                   ImageSize size) {
  constexpr int kTimes = 16;
  Image mean;
  for (int i = 0; i < kTimes; ++i) {
    const uint64_t key = seed * 1000 + uint64_t(i);
    const double time = shutter * (i + toUnit(uint32_t(hash(key)))) / kTimes;
    const Image still = rendered(scene, settingsOf(time, {}, key, samples, size));
    if (i == 0) mean = Image(still.width, still.height, 3);
    for (int y = 0; y < still.height; ++y)
      for (int x = 0; x < still.width; ++x)
        mean.setRgb(x, y, mean.rgb(x, y) + still.rgb(x, y) * (1.0f / kTimes));
  }
  return mean;
}

void expectMeanOfStills(const std::string& scene, double shutter, ImageSize size) {
  std::vector<Image> open, stills;
  for (uint64_t i = 0; i < 6; ++i) {
    open.push_back(rendered(scene, settingsOf(0, shutter, 900 + i, 64, size)));
    stills.push_back(meanOfStills(scene, shutter, i, 4, size));
  }
  const Agreement found = agreement(open, stills);
  EXPECT_GT(found.pValue, 1e-4);
  const std::vector<Image> first{rendered(scene, settingsOf(0, {}, 1, 64, size)),
                                 rendered(scene, settingsOf(0, {}, 2, 64, size))};
  EXPECT_LT(agreement(first, stills).pValue, 1e-4) << "it must move enough to be seen";
}

// A glowing sheet that turns and is stretched, a lamp and a camera that move, above a floor with a
// body of glass and a shared box that moves.
class Everything {
 public:
  Everything() {
    w_.add("materials", {{"pbrMetallicRoughness",
                          {{"baseColorFactor", {.7, .5, .3, 1}}, {"metallicFactor", 0}}}});
    w_.add("materials", {{"emissiveFactor", {1, .8, .5}},
                         {"doubleSided", true},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {.2, .2, .2, 1}}}}});
    w_.add("materials", {{"alphaMode", "BLEND"},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {.2, .4, .8, .5}}}}});
    const auto sheet = [&](int material, float side, float height) {
      return json{{"material", material},
                  {"indices", w_.indices({0, 2, 1, 0, 3, 2})},
                  {"attributes",
                   {{"POSITION", w_.vec3s({-side, height, -side, side, height, -side, side, height,
                                           side, -side, height, side})}}}};
    };
    const int floor = w_.mesh(sheet(0, 3, 0)), blended = w_.mesh(sheet(2, .5f, .4f));
    json glowing = sheet(1, .3f, 0);
    glowing["targets"] = {{{"POSITION", w_.vec3s({-1, 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0})}}};
    const int lamp = w_.mesh(glowing);
    w_.root["meshes"][size_t(lamp)]["weights"] = {0};
    const int floorNode = w_.add("nodes", {{"mesh", floor}});
    const int lampNode = w_.add("nodes", {{"mesh", lamp}, {"translation", {-1, 1, 0}}});
    const int boxA = w_.add("nodes", {{"mesh", blended}, {"translation", {.5, 0, 1}}});
    const int boxB = w_.add("nodes", {{"mesh", blended}, {"translation", {1, 0, -1}}});
    w_.root["extensionsUsed"] = {"KHR_lights_punctual"};
    w_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 683}}};
    const int bulb = w_.add("nodes", {{"translation", {1, 1.5, 0}},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    w_.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", .8}, {"znear", .1}}}});
    const int eye = w_.add("nodes", {{"camera", 0}});
    for (const int node : {floorNode, lampNode, boxA, boxB, bulb, eye}) nodes_.push_back(node);
    w_.root["scenes"] = {{{"nodes", nodes_}}};
    w_.root["scene"] = 0;
    const std::vector<float> times{0, 1}, weights{0, 1};
    times_ = w_.accessor(w_.view(times), kFloat, "SCALAR", 2);
    w_.add("animations", json::object());
    animate(lampNode, "weights", w_.accessor(w_.view(weights), kFloat, "SCALAR", 2));
    animate(lampNode, "translation", w_.vec3s({-1, 1, 0, -.5, .8f, .8f}));
    animate(boxA, "translation", w_.vec3s({.5f, 0, 1, -.5f, .3f, .5f}));
    animate(bulb, "translation", w_.vec3s({1, 1.5f, 0, 1, 1, -1}));
    animate(eye, "translation", w_.vec3s({0, 2, 5, .3f, 2.2f, 5}));
    // Looks down by 0.3 and turns by 0.1 about Y.
    const std::vector<float> looks{-.1494f, 0, 0, .9888f, -.1492f, .0494f, -.0075f, .9876f};
    animate(eye, "rotation", w_.accessor(w_.view(looks), kFloat, "VEC4", 2));
    path_ = w_.save();
  }

  const std::string& path() const { return path_; }

 private:
  void animate(int node, const char* path, int output) {
    json& animation = w_.root["animations"][0];
    animation["samplers"].push_back({{"input", times_}, {"output", output}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  GltfWriter w_;
  std::vector<int> nodes_;
  int times_ = 0;
  std::string path_;
};

TEST(SlowMotionBlur, IsTheMeanOfStills) {
  const Everything scene;
  expectMeanOfStills(scene.path(), 1, {48, 32});
}

TEST(SlowMotionBlur, OfARealModelIsTheMeanOfStills) {
  const auto model = sharedData("gltf/Fox/glTF/Fox.gltf");
  if (!model) GTEST_SKIP() << "no shared data: gltf/Fox";
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.toml")
      << "model = \"" << model->string() << "\"\n[probe]\nfile = \"" << kSourceDir
      << "/probes/dusk.exr\"\n"
      << "[camera]\nzoom = 1.7\nshutter_steps = 32\n";
  expectMeanOfStills(folder / "scene.toml", 0.25, {48, 32});
}

// The sampler's times are uniform, and independent of its positions in the pixel.
TEST(MotionBlur, TimesAreUniformInEveryPartOfThePixel) {
  const SobolTable table(256, 12, 3);
  PixelSampler sampler(table, 3);
  constexpr int kBins = 8, kPixels = 400;
  for (const int other : {dimension::kPixel, dimension::kPixel + 1, dimension::kLens}) {
    std::vector<double> counts(kBins * kBins, 0);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      sampler.startPixel(pixel, 7, 0);
      for (uint32_t i = 0; i < 256; ++i) {
        sampler.startSample(i);
        const int a = int(sampler.time() * kBins), b = int(sampler.get1(other) * kBins);
        ASSERT_TRUE(a >= 0 && a < kBins);
        ++counts[size_t(a * kBins + b)];
      }
    }
    double chi2 = 0;
    const double expected = 256.0 * kPixels / (kBins * kBins);
    for (const double n : counts) chi2 += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi2, 63 + 4.5 * std::sqrt(2 * 63.0)) << other;
  }
  // In one pixel they are stratified.
  std::vector<int> strata(256, 0);
  sampler.startPixel(1, 1, 0);
  for (uint32_t i = 0; i < 256; ++i) {
    sampler.startSample(i);
    ++strata[size_t(sampler.time() * 256)];
  }
  EXPECT_EQ(strata, std::vector<int>(256, 1));
}

TEST(MotionBlur, CamerasTurnAtConstantSpeed) {
  Camera camera = Camera::lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1);
  const Camera to = Camera::lookAt({2, 0, 0}, {3, 0, 0}, {0, 1, 0}, 1);
  camera.motion = std::make_shared<const std::vector<Camera>>(std::vector<Camera>{camera, to});
  const MovingCamera moving(camera, 1);
  for (const float time : {0.0f, 0.25f, 0.5f, 1.0f}) {
    vec3 origin, direction;
    moving.at(time).ray(0.5f, 0.5f, origin, direction);
    EXPECT_NEAR(glm::distance(origin, vec3(2 * time, 0, 0)), 0, 1e-6);
    const float angle = time * kPi / 2;
    EXPECT_NEAR(glm::distance(direction, vec3(std::sin(angle), 0, -std::cos(angle))), 0, 1e-6);
  }
}

TEST(SlowMotionBlur, AStillSceneKeepsItsBits) {
  const MovingSquare square(Mover::Node);
  // After its last key the animation stands still.
  const Image closed = rendered(square.path(), settingsOf(20, {}, 1, 16, {32, 24}));
  const Image open = rendered(square.path(), settingsOf(20, 1.0, 1, 16, {32, 24}));
  EXPECT_EQ(open.texels, closed.texels);
}

Words words(const std::string& scene, const Words& more, const std::string& output) {
  Words all{"render", scene, "--size", "32x24", "--samples", "4", "--quiet", "-o", output};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string run(const Words& arguments) {
  const CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result.error;
}

TEST(SlowMotionBlur, FramesAreStillsOfAnyNumberOfThreads) {
  const Everything scene;
  const TemporaryFolder out;
  const Words open{"--shutter", "0.5", "--fps", "4"};
  Words frames = open;
  frames.insert(frames.end(), {"--frames", "0:3", "--orbit", "40", "--threads", "2"});
  run(words(scene.path(), frames, out / "frame.#.exr"));
  for (const int number : {0, 3}) {
    Words still = open;
    still.insert(still.end(), {"--animation-time", fmt::format("{}", 0.25 * number), "--orbit",
                               fmt::format("{}", 10 * number), "--orbit-step", "10"});
    run(words(scene.path(), still, out / "still.exr"));
    EXPECT_EQ(readImage(out / fmt::format("frame.{}.exr", number)).texels,
              readImage(out / "still.exr").texels);
  }
  run(words(scene.path(), {"--animation-time", "0", "--fps", "4", "--shutter", "0"},
            out / "closed.exr"));
  run(words(scene.path(), {"--animation-time", "0"}, out / "instant.exr"));
  EXPECT_EQ(readImage(out / "closed.exr").texels, readImage(out / "instant.exr").texels);
}

TEST(MotionBlur, WarnsOfFewStepsAndOfWhatVanishes) {
  GltfWriter w;
  const int spinning = addTriangle(w), vanishing = addTriangle(w, {}, {{"name", "ghost"}});
  const std::vector<float> times{0, 1}, turns{0, 0, 0, 1, 0, 0, 1, 0};
  const int input = w.accessor(w.view(times), kFloat, "SCALAR", 2);
  w.add(
      "animations",
      {{"channels",
        {{{"sampler", 0}, {"target", {{"node", spinning}, {"path", "rotation"}}}},
         {{"sampler", 1}, {"target", {{"node", vanishing}, {"path", "scale"}}}}}},
       {"samplers",
        {{{"input", input}, {"output", w.accessor(w.view(turns), kFloat, "VEC4", 2)}},
         {{"input", input}, {"interpolation", "STEP"}, {"output", w.vec3s({1, 1, 1, 0, 0, 0})}}}}});
  const std::string path = w.save();
  const TemporaryFolder out;
  const auto messages = [&](const char* steps) {
    return runCommand({"render", path, "--probe", std::string(kSourceDir) + "/probes/dusk.exr",
                       "--animation-time", "0", "--fps", "1", "--shutter", "1", "--shutter-steps",
                       steps, "--size", "8x8", "--samples", "2", "-o", out / "a.exr"})
        .error;
  };
  // Half a turn along one chord: its middle is at the centre instead of 1 m away.
  EXPECT_NE(messages("1").find("misses their way by up to 1 m"), std::string::npos)
      << messages("1");
  EXPECT_NE(messages("1").find("4 steps of the shutter"), std::string::npos);
  EXPECT_EQ(messages("64").find("their way"), std::string::npos) << messages("64");
  EXPECT_NE(messages("64").find("`ghost` appears, vanishes or is mirrored"), std::string::npos);
}

// Its front would become its back.
TEST(MotionBlur, WarnsOfWhatIsTurnedInsideOut) {
  for (const bool isShared : {false, true}) {
    GltfWriter w;
    const int turned = addTriangle(w, {}, {{"name", "glove"}});
    if (isShared) w.add("nodes", {{"mesh", 0}, {"translation", {0, 2, 0}}});
    const std::vector<float> times{0, 1};
    w.add("animations",
          {{"channels", {{{"sampler", 0}, {"target", {{"node", turned}, {"path", "scale"}}}}}},
           {"samplers",
            {{{"input", w.accessor(w.view(times), kFloat, "SCALAR", 2)},
              {"output", w.vec3s({1, 1, 1, -1, 1, 1})}}}}});
    const std::string path = w.save();
    Settings settings = settingsOf(0, 1.0, 1, 2, {8, 8});
    settings.set("camera.shutter_steps", uint64_t(1));
    RenderDescription description = planRender(openScene(path), settings);
    std::vector<std::string> texts;
    description.lamps.push_back({.ambient = AmbientLamp{Rgb(1)}});
    const LoadedScene loaded = loadScene(description);
    for (const Message& message : loaded.messages) texts.push_back(message.text);
    EXPECT_TRUE(std::ranges::any_of(texts, [](const std::string& text) {
      return text.find("`glove` appears, vanishes or is mirrored") != std::string::npos;
    })) << isShared;
  }
}

TEST(MotionBlur, RefusesWhatHasNoMeaning) {
  const MovingSquare square(Mover::Node);
  const TemporaryFolder out;
  const auto refuses = [&](const Words& options, const std::string& why) {
    expectError(words(square.path(), options, out / "a.#.exr"), why);
  };
  refuses({"--fps", "12"}, "--fps: needs --frames A:B or --shutter");
  refuses({"--shutter", "-1"}, "--shutter");
  refuses({"--shutter", "nan"}, "--shutter");
  refuses({"--shutter", "1", "--shutter-steps", "0"}, "--shutter-steps");
  refuses({"--shutter", "1", "--shutter-steps", "129"}, "--shutter-steps");
  refuses({"--orbit-step", "3"}, "--orbit-step: needs an open shutter; see --shutter");
  refuses({"--frames", "0:1", "--orbit-step", "3"}, "--orbit-step: frames turn by --orbit");
  refuses({"--shutter", "0.5", "--irradiance-cache", "0.1"},
          "not with an open shutter; leave one of the two out; see --shutter");
  refuses({"--probe-sequence", "p.#.exr"}, "--probe-sequence: needs --frames");
  refuses({"--frames", "0:1", "--probe-sequence", "p.exr"}, "has no #");
  refuses({"--frames", "0:1", "--probe-sequence", out / "p.#.exr"}, "p.0.exr");
  refuses({"--frames", "0:1", "--probe-sequence", out / "p.#.exr", "--probe", "q.exr"}, "--probe");
}

// All probes that are needed are checked before the first frame; finished frames need none.
TEST(MotionBlur, MissingProbesOfFramesAreFoundAtOnce) {
  const MovingSquare square(Mover::Camera);
  const TemporaryFolder out;
  const auto frames = [&](const char* range, const Words& more = {}) {
    Words options{"--frames", range, "--probe-sequence", out / "probe.#.exr"};
    options.insert(options.end(), more.begin(), more.end());
    return words(square.path(), options, out / "a.#.exr");
  };
  for (const int i : {0, 1, 3}) {
    const std::string path = out / fmt::format("probe.{}.exr", i);
    writeImage(path, constantProbe({8, 4}, Rgb(1)));
  }
  expectError(frames("0:3"), "probe.2.exr: no such file");
  expectError(frames("0:5"), "probe.2.exr: no such file; 2 more of the frames' probes are missing");
  EXPECT_FALSE(std::filesystem::exists(out / "a.0.exr"));
  EXPECT_EQ(runCommand(frames("0:1")).status, 0);
  std::filesystem::remove(out / "probe.0.exr");
  EXPECT_EQ(runCommand(frames("0:1")).status, 0);
  expectError(frames("0:1", {"--overwrite"}), "probe.0.exr: no such file");
}

TEST(SlowMotionBlur, EveryFrameHasItsProbe) {
  const MovingSquare square(Mover::Camera);
  const TemporaryFolder out;
  for (int i = 0; i < 3; ++i)
    writeImage(out / fmt::format("probe.{:02}.exr", i),
               constantProbe({8, 4}, Rgb(float(i + 1), 1, 0.5f)));
  run(words(square.path(),
            {"--frames", "0:2", "--fps", "1", "--probe-sequence", out / "probe.##.exr", "--shutter",
             "0.5"},
            out / "frame.#.exr"));
  for (int i = 0; i < 3; ++i) {
    const ImageFile frame = readImageFile(out / fmt::format("frame.{}.exr", i));
    EXPECT_EQ(frame.image.rgb(0, 0), Rgb(float(i + 1), 1, 0.5f));
    EXPECT_EQ(std::get<std::string>(frame.metadata.at("probe")),
              out / fmt::format("probe.{:02}.exr", i));
    run(words(square.path(),
              {"--animation-time", fmt::format("{}", i), "--fps", "1", "--shutter", "0.5",
               "--probe", out / fmt::format("probe.{:02}.exr", i)},
              out / "still.exr"));
    EXPECT_EQ(frame.image.texels, readImage(out / "still.exr").texels);
  }
}

}  // namespace
}  // namespace chromeball::motion_blur_test

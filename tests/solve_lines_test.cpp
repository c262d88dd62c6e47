// SPDX-License-Identifier: Apache-2.0
// Cameras found from lines along the axes of the scene, and cameras read from fSpy.
#include "scene/solve/solve_camera.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "photographs_of_points.h"
#include "run_command.h"

namespace chromeball::solve_lines_test {
namespace {

ObservedLine lineOf(const SolvedCamera& camera, int axis, const dvec3& from, double length) {
  dvec3 to = from;
  to[axis] += length;
  return {"L.csv:1", axis, pixelOf(camera, from).value(), pixelOf(camera, to).value(), {}};
}

// `each` lines along each of the axes.
std::vector<ObservedLine> linesOf(const SolvedCamera& camera, const std::vector<int>& axes,
                                  int each, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<ObservedLine> lines;
  for (const int axis : axes)
    for (int i = 0; i < each; ++i) {
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      lines.push_back(lineOf(camera, axis, {x, y, z}, 0.4));
    }
  return lines;
}

TEST(SolveLines, ExactLinesGiveTheCamera) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const double azimuth = (trial + 0.5) * kPiD / 20;  // from all sides
    const double height = 1 + 2 * uniform(random), fov = 30 + 40 * uniform(random);
    SolvedCamera truth =
        photographFrom({5 * std::sin(azimuth), height, 5 * std::cos(azimuth)}, {0.1, 0.2, 0}, fov);
    truth.principalPoint = {0.48, 0.53};
    CameraKnowledge known{.size = truth.size, .principalPoint = truth.principalPoint};
    for (const auto& axes : {std::vector{0, 2}, {0, 1}, {1, 2}, {0, 1, 2}}) {
      const auto lines = linesOf(truth, axes, 2, random);
      const CameraFit fit = solveByLines(lines, known, {.height = height, .origin = {}}, "L");
      EXPECT_LT(glm::length(turnBetween(truth.axes, fit.camera.axes)), 1e-8) << trial;
      EXPECT_LT(std::abs(fit.camera.focalLength / truth.focalLength - 1), 1e-7) << trial;
      EXPECT_LT(fit.rms(), 1e-7);
      EXPECT_EQ(fit.camera.position, dvec3(0, height, 0));
    }
    known.focalLength = truth.focalLength;
    const CameraFit fit =
        solveByLines(linesOf(truth, {0, 2}, 2, random), known, {.height = 1, .origin = {}}, "L");
    EXPECT_LT(glm::length(turnBetween(truth.axes, fit.camera.axes)), 1e-8) << trial;
    EXPECT_FALSE(fit.errors.fov);
  }
}

// Scale and origin: by a length on the ground, by the height of a post on it, and by the height
// of the camera with a pixel for the origin.
TEST(SolveLines, ALengthOrAHeightPlacesTheCamera) {
  const SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0.2, 0}, 50);
  const CameraKnowledge known{.size = truth.size};
  std::mt19937 random(2);
  const auto lines = linesOf(truth, {0, 1, 2}, 2, random);
  const dvec3 foot(0.2, 0, -0.3);
  for (int axis = 0; axis < 3; ++axis) {
    auto withLength = lines;
    withLength.push_back(lineOf(truth, axis, foot, 0.6));
    withLength.back().length = 0.6;
    const dvec3 found = solveByLines(withLength, known, {}, "L").camera.position;
    EXPECT_LT(glm::distance(found, truth.position - foot), 1e-7) << axis;
    const LinePlacement atOrigin{.height = {}, .origin = pixelOf(truth, dvec3(0))};
    EXPECT_LT(glm::distance(solveByLines(withLength, known, atOrigin, "L").camera.position,
                            truth.position),
              1e-7);
  }
  const LinePlacement byHeight{.height = 1.7, .origin = pixelOf(truth, foot)};
  EXPECT_LT(glm::distance(solveByLines(lines, known, byHeight, "L").camera.position,
                          truth.position - foot),
            1e-7);
}

TEST(SolveLines, NoisyLinesHaveErrorsOfTheRightSize) {
  const SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0.2, 0}, 50);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double squares = 0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto lines = linesOf(truth, {0, 1, 2}, 4, random);
    for (ObservedLine& line : lines)
      for (dvec2* end : {&line.from, &line.to})
        for (int axis = 0; axis < 2; ++axis) (*end)[axis] += 0.5 * normal(random);
    const CameraFit fit =
        solveByLines(lines, {.size = truth.size}, {.height = 1, .origin = {}}, "L");
    const double ratio = (fit.camera.fov() - truth.fov()) / *fit.errors.fov;
    squares += ratio * ratio / kTrials;
  }
  // The square of Student's t with 8 degrees of freedom: mean 8 / 6, mean square 8.
  EXPECT_NEAR(squares, 8.0 / 6, 4 * std::sqrt((8 - 64.0 / 36) / kTrials));
}

void expectError(const std::vector<ObservedLine>& lines, const LinePlacement& placement,
                 const std::string& reason, std::optional<double> focalLength = {}) {
  try {
    const CameraKnowledge known{.size = {1600, 1200}, .focalLength = focalLength};
    solveByLines(lines, known, placement, "L.csv");
    ADD_FAILURE() << "no error: " << reason;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(SolveLines, RefusesWhatLeavesTheCameraOpen) {
  const SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0.2, 0}, 50);
  std::mt19937 random(4);
  const LinePlacement height{.height = 1.7, .origin = {}};
  auto lines = linesOf(truth, {0, 2}, 2, random);
  expectError({lines[0], lines[1], lines[2]}, height,
              "has 2 lines along x, 0 along y and 1 along z");
  expectError(lines, {}, "L.csv: nothing tells the scale");
  expectError(lines, {.height = 1.7, .origin = dvec2(800, -100)},
              "the origin: is not below the horizon");
  auto reversed = lines;
  std::swap(reversed[3].from, reversed[3].to);
  expectError(reversed, height, "the line runs along z in the opposite direction as that of");
  auto three = linesOf(truth, {0, 1, 2}, 2, random);
  for (size_t i : {2u, 3u}) std::swap(three[i].from, three[i].to);
  expectError(three, height, "left-handed");
  lines.push_back(lineOf(truth, 0, {0, 0, 0}, 0.5));
  lines.back().length = 0.5;
  expectError(lines, height, "leave out the height, or the length");

  // Both axes parallel to the picture: any field of view fits.
  const auto flat = [](int axis, double x, double y) {
    const dvec2 along = axis == 0 ? dvec2(300, 0) : dvec2(0, -300);
    return ObservedLine{"L.csv:1", axis, {x, y}, dvec2(x, y) + along, {}};
  };
  const std::vector<ObservedLine> facing{flat(0, 100, 100), flat(0, 900, 1000), flat(1, 200, 900),
                                         flat(1, 1300, 1100)};
  expectError(facing, height, "the lines do not tell the field of view");
  EXPECT_NO_THROW(solveByLines(facing, {.size = {1600, 1200}, .focalLength = 1500},
                               {.height = 1, .origin = {}}, "L.csv"));
}

// fSpy's export for a camera: rows of its transform, and so on.
std::string fspyJson(const SolvedCamera& c, const std::string& width = "1600") {
  const auto row = [&](int i) {
    return fmt::format("[{},{},{},{}]", c.axes[0][i], c.axes[1][i], c.axes[2][i], c.position[i]);
  };
  const double longer = std::max(c.size.width, c.size.height);
  return fmt::format(
      "{{\"principalPoint\":{{\"x\":{},\"y\":{}}},"
      "\"cameraTransform\":{{\"rows\":[{},{},{},[0,0,0,1]]}},"
      "\"horizontalFieldOfView\":1,\"verticalFieldOfView\":{},\"vanishingPoints\":[],"
      "\"relativeFocalLength\":1,\"imageWidth\":{},\"imageHeight\":{}}}",
      2 * (c.principalPoint.x - 0.5) * c.size.width / longer,
      -2 * (c.principalPoint.y - 0.5) * c.size.height / longer, row(0), row(1), row(2), c.fov(),
      width, c.size.height);
}

class Fspy : public testing::Test {
 protected:
  std::string write(const std::string& text) const {
    std::ofstream(folder_ / "camera.json") << text;
    return folder_ / "camera.json";
  }
  TemporaryFolder folder_;
};

TEST_F(Fspy, ReadsPoseFieldOfViewAndPrincipalPoint) {
  SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0.2, 0}, 50);
  truth.principalPoint = {0.4, 0.55};
  for (const ImageSize& size : {ImageSize{1600, 1200}, ImageSize{1600, 2000}}) {
    truth.size = size;
    const SolvedCamera found = readFspy(write(fspyJson(truth)), false);
    EXPECT_LT(glm::length(turnBetween(truth.axes, found.axes)), 1e-12);
    EXPECT_EQ(found.position, truth.position);
    EXPECT_NEAR(found.fov(), truth.fov(), 1e-12);
    EXPECT_LT(glm::distance(found.principalPoint, truth.principalPoint), 1e-12);
  }
  // Z up: the camera's position (x, y, z) is (x, z, -y).
  const SolvedCamera turned = readFspy(write(fspyJson(truth)), true);
  EXPECT_EQ(turned.position, dvec3(1, 3, -1.7));
  EXPECT_NEAR(glm::determinant(turned.axes), 1, 1e-12);
}

// An export of fSpy: its vanishing point of -z is where the camera sees the direction -z.
TEST_F(Fspy, AgreesWithTheVanishingPointsOfAnExport) {
  const SolvedCamera found =
      readFspy(write(R"({"principalPoint":{"x":0,"y":0},"cameraTransform":{"rows":[
[-0.9734138207025481,0.04196681158657723,-0.22517619854355045,-0.6959172306086093],
[0.0965054651828195,-0.8164170790874036,-0.5693415918095569,-4.4653045032151235],
[-0.2077311456068041,-0.5759357079567556,0.7906616415668815,9.234054171727681],[0,0,0,1]]},
"verticalFieldOfView":1.097495385241209,"imageWidth":4032,"imageHeight":3024})"),
               false);
  const dvec3 seen = glm::transpose(found.axes) * dvec3(0, 0, -1);
  const dvec2 pixels = found.focalLength * dvec2(seen.x, seen.y) / -seen.z;
  EXPECT_NEAR(pixels.x / 2016, 0.3222986638911469, 1e-9);
  EXPECT_NEAR(pixels.y / 2016, 0.8935747627994785, 1e-9);
}

TEST_F(Fspy, RefusesOtherFiles) {
  const SolvedCamera truth = photographFrom({1, 1.7, 3}, {0, 0.2, 0}, 50);
  const std::string good = fspyJson(truth);
  const auto refuse = [&](const std::string& text, const std::string& reason) {
    try {
      readFspy(write(text), false);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refuse("fspy\1\2", "is not JSON with the camera parameters of fSpy");
  refuse("[1, 2]", "is not JSON with the camera parameters of fSpy");
  refuse("{}", "`imageWidth` should be a number between 0 and 1e+06");
  refuse(fspyJson(truth, "1e99"), "`imageWidth` should be a number between 0 and 1e+06");
  refuse(fspyJson(truth, "0.2"), "`imageWidth` should be 1 or more");
  std::string skewed = good;
  skewed.replace(skewed.find("rows\":[[") + 8, 3, "9.9");
  refuse(skewed, "`cameraTransform` should be a rotation and a translation");
  for (const char* number : {"1e160", "-1e300", "1e10"}) {  // whose squares may overflow
    std::string far = good, shifted = good;
    far.replace(far.find("],[0,0,0,1]]") - 1, 1, number);
    refuse(far, "`cameraTransform/rows/2/3` should be a number between -1e+09 and 1e+09");
    shifted.replace(shifted.find("\"y\":") + 4, 1, std::string(number) + ",\"unused\":");
    refuse(shifted, "`principalPoint/y` should be a number between -1e+09 and 1e+09");
  }
  EXPECT_THROW(readFspy(folder_ / "none.json", false), InputError);
}

}  // namespace
}  // namespace chromeball::solve_lines_test

// SPDX-License-Identifier: Apache-2.0
// Cameras found from points of known positions.
#include "hypothesis.h"
#include "scene/solve/solve_camera.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "math/rotation.h"
#include "photographs_of_points.h"

namespace chromeball::solve_points_test {
namespace {

const dvec3 kRoom(2, 1.5, 2), kTable(1, 0, 0.7);

SolvedCamera randomCamera(std::mt19937& random, double k1) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double azimuth = 2 * kPiD * uniform(random), distance = 4 + 3 * uniform(random);
  const double height = 0.5 + 3 * uniform(random), fov = 30 + 40 * uniform(random);
  const dvec3 position(distance * std::sin(azimuth), height, distance * std::cos(azimuth));
  return photographFrom(position, dvec3(0.2, 0.1, -0.1), fov, k1);
}

CameraKnowledge knowledge(const SolvedCamera& truth, bool knowsFocalLength) {
  CameraKnowledge known{.size = truth.size, .principalPoint = truth.principalPoint};
  if (knowsFocalLength) known.focalLength = truth.focalLength;
  known.findsDistortion = truth.distortion.k1 != 0;
  return known;
}

double errorOf(const SolvedCamera& found, const SolvedCamera& truth) {
  return std::max({glm::length(found.position - truth.position) / glm::length(truth.position),
                   glm::length(turnBetween(truth.axes, found.axes)),
                   std::abs(found.focalLength / truth.focalLength - 1),
                   std::abs(found.distortion.k1 - truth.distortion.k1)});
}

// Without errors in the picture the camera is exact, from any direction, with points on a plane
// and off it, few and many.
TEST(SolvePoints, ExactPointsGiveTheCamera) {
  struct Case {
    size_t count;
    bool knowsFocalLength;
    double k1;
    dvec3 half;
  };
  std::mt19937 random(5);
  for (const Case& c :
       {Case{12, false, 0, kRoom}, Case{12, false, -0.05, kRoom}, Case{12, false, 0.08, kRoom},
        Case{6, false, 0, kRoom}, Case{6, true, 0, kRoom}, Case{8, false, 0, kTable},
        Case{5, true, 0, kTable}, Case{40, false, -0.05, kTable}})
    for (int trial = 0; trial < 10; ++trial) {
      SolvedCamera truth = randomCamera(random, c.k1);
      truth.principalPoint = {0.45, 0.56};
      const auto points = observe(truth, c.count, c.half, 0, random);
      SCOPED_TRACE(
          fmt::format("{} points, trial {}, k1 {}, flat {}", c.count, trial, c.k1, c.half.y == 0));
      CameraFit fit;
      ASSERT_NO_THROW(fit = solveByPoints(points, knowledge(truth, c.knowsFocalLength), "P"));
      EXPECT_LT(errorOf(fit.camera, truth), 1e-8) << c.count << " points, k1 " << c.k1;
      EXPECT_LT(fit.rms(), 1e-7);
    }
}

// With normal errors of 0.5 pixels, each error over its standard error has Student's t distribution
// with 2 x 12 - 7 (or 8) degrees of freedom: its p-values are uniform, and few errors exceed three
// standard errors.
TEST(SlowSolvePoints, StandardErrorsAreRight) {
  constexpr int kTrials = 200, kBins = 10, kPoints = 12;
  for (const double k1 : {0.0, -0.05}) {
    const int unknowns = k1 == 0 ? 7 : 8, freedom = 2 * kPoints - unknowns;
    std::vector<std::vector<double>> bins(unknowns, std::vector<double>(kBins));
    std::vector<int> beyond(size_t(unknowns), 0);
    std::mt19937 random(11);
    double squares = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const SolvedCamera truth = randomCamera(random, k1);
      const auto points = observe(truth, kPoints, kRoom, 0.5, random);
      const CameraFit fit = solveByPoints(points, knowledge(truth, false), "P");
      const dvec3 moved = fit.camera.position - truth.position;
      const dvec3 turned = turnBetween(truth.axes, fit.camera.axes);
      std::vector<double> ratios;
      for (int axis = 0; axis < 3; ++axis) {
        ratios.push_back(moved[axis] / (*fit.errors.position)[axis]);
        ratios.push_back(turned[axis] / fit.errors.rotation[axis]);
      }
      ratios.push_back((fit.camera.fov() - truth.fov()) / *fit.errors.fov);
      if (k1 != 0) ratios.push_back((fit.camera.distortion.k1 - k1) / *fit.errors.k1);
      for (size_t i = 0; i < ratios.size(); ++i) {
        // The t-test of so many values whose mean has this t.
        const double p = tTest({freedom + 1, ratios[i], freedom + 1.0}, 0);
        ++bins[i][size_t(std::min(int(p * kBins), kBins - 1))];
        beyond[i] += std::abs(ratios[i]) > 3;
      }
      squares += kPoints * fit.rms() * fit.rms() / freedom;
    }
    const std::vector<double> expected(kBins, double(kTrials) / kBins);
    for (size_t i = 0; i < bins.size(); ++i) {
      EXPECT_GT(chiSquareTest(bins[i], expected).pValue, sidak(1e-3, unknowns)) << "unknown " << i;
      // The t distribution has 0.8% beyond 3: 1.6 of 200. More than 8 have a probability of 5e-5.
      EXPECT_LE(beyond[i], 8) << "unknown " << i;
    }
    // The variance of one coordinate, 0.25: relative standard deviation sqrt(2 / 200 / freedom).
    EXPECT_NEAR(squares / kTrials, 0.25, 0.25 * 4 * std::sqrt(2.0 / kTrials / freedom));
  }
}

// Given values are not solved for, and have no error.
TEST(SolvePoints, AKnownFieldOfViewStays) {
  std::mt19937 random(2);
  const SolvedCamera truth = randomCamera(random, 0);
  const auto points = observe(truth, 5, kRoom, 0.5, random);
  const CameraFit fit = solveByPoints(points, knowledge(truth, true), "P");
  EXPECT_DOUBLE_EQ(fit.camera.focalLength, truth.focalLength);
  EXPECT_FALSE(fit.errors.fov || fit.errors.k1);
  EXPECT_GT(fit.errors.position->x, 0);
}

TEST(SolvePoints, TheWorstPointIsTheMovedOne) {
  std::mt19937 random(3);
  const SolvedCamera truth = randomCamera(random, 0);
  auto points = observe(truth, 12, kRoom, 0, random);
  points[7].pixel += dvec2(30, -40);
  const CameraFit fit = solveByPoints(points, knowledge(truth, false), "P");
  EXPECT_EQ(fit.worst(), 7u);
  EXPECT_LT(fit.distances[7], 50);
}

// Seen from far away, four corners of a table fit two cameras.
TEST(SolvePoints, TellsOfTwoCamerasThatFit) {
  const SolvedCamera truth = photographFrom({0, 480, 640}, {0, 0, 0}, 0.1875);
  std::vector<ObservedPoint> points;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (const dvec3& corner : {dvec3(-1, 0, -1), dvec3(1, 0, -1), dvec3(1, 0, 1), dvec3(-1, 0, 1)}) {
    const double right = normal(random), down = normal(random);
    points.push_back({fmt::format("c{}", points.size()), "P:1", corner,
                      *pixelOf(truth, corner) + dvec2(right, down)});
  }
  const CameraFit fit = solveByPoints(points, knowledge(truth, true), "P");
  ASSERT_TRUE(fit.rivalRms);
  const Messages doubts = doubtsAbout(fit);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].text.find("another camera fits nearly as well"), std::string::npos);
}

void expectError(const std::vector<ObservedPoint>& points, const CameraKnowledge& known,
                 const std::string& reason) {
  try {
    solveByPoints(points, known, "P.csv");
    ADD_FAILURE() << "no error: " << reason;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(SolvePoints, RefusesPointsThatLeaveTheCameraOpen) {
  std::mt19937 random(6);
  const SolvedCamera truth = photographFrom({0.3, 2, 5}, {0, 0, 0}, 40);
  const auto open = knowledge(truth, false), given = knowledge(truth, true);
  auto points = observe(truth, 12, kRoom, 0, random);
  const auto some = [&](size_t count) {
    return std::vector(points.begin(), points.begin() + ptrdiff_t(count));
  };
  expectError(some(5), open,
              "P.csv: 5 points are too few for a camera and its field of view; it "
              "takes 6, or 4 if the field of view is given");
  expectError(some(3), given, "3 points are too few for a camera's position and rotation");
  EXPECT_NO_THROW(solveByPoints(some(4), given, "P.csv"));

  auto twice = points;
  twice[3].position = twice[1].position;
  expectError(twice, open, "points.csv:1: `p3` is at the same position as `p1`");
  auto line = points;
  for (size_t i = 0; i < line.size(); ++i) line[i].position = dvec3(1, 2, 3) + 0.1 * double(i);
  expectError(line, open, "P.csv: the points lie on a line");
  auto spot = points;
  for (ObservedPoint& p : spot) p.pixel = {100, 100};
  expectError(spot, open, "all points have the same place in the picture");

  // A plane that faces the camera: distance and focal length have the same effect.
  const SolvedCamera above = photographFrom({0, 5, 0}, {0, 0, 0}, 40);
  const auto floor = observe(above, 12, kTable, 0, random);
  expectError(floor, knowledge(above, false), "field of view");
  EXPECT_NO_THROW(solveByPoints(floor, knowledge(above, true), "P.csv"));
}

TEST(SolvePoints, TellsOfPointsThatFitNoCamera) {
  std::mt19937 random(7);
  const SolvedCamera truth = photographFrom({0.3, 2, 5}, {0, 0, 0}, 40);
  auto points = observe(truth, 8, kRoom, 0, random);
  for (ObservedPoint& p : points) p.pixel.y = truth.size.height - p.pixel.y;  // from the bottom
  const Messages doubts = doubtsAbout(solveByPoints(points, knowledge(truth, true), "P"));
  ASSERT_FALSE(doubts.empty());
  EXPECT_NE(doubts[0].text.find("no camera fits"), std::string::npos) << doubts[0].text;
  points[2].pixel.x = -5;
  EXPECT_EQ(doubtsAbout(points, truth.size).size(), 1u);
}

TEST(SolvePoints, SpreadRotationsLeaveNoGap) {
  const std::vector<glm::dmat3> spread = spreadRotations(128), random = spreadRotations(1001);
  for (const glm::dmat3& rotation : random) {
    double nearest = kPiD;
    for (const glm::dmat3& other : spread)
      nearest = std::min(nearest, angleBetween(rotation, other));
    EXPECT_LT(nearest, glm::radians(60.0));
  }
}

TEST(SolvedCamera, FocalLengthsOn35mmFilmHaveTheSameDiagonal) {
  // A sensor of 36 x 24 mm with 100 pixels per mm.
  EXPECT_NEAR(focalLengthOf35mm({3600, 2400}, 50), 5000, 1e-9);
  // The diagonal of a photograph of 4:3 at 28 mm: 2 atan(43.27 / 56) = 75.4 degrees.
  const double f = focalLengthOf35mm({4032, 3024}, 28);
  EXPECT_NEAR(glm::degrees(2 * std::atan(0.5 * std::hypot(4032, 3024) / f)), 75.38, 0.01);
  EXPECT_NEAR(equivalentOn35mm({4032, 3024}, f), 28, 1e-12);
}

}  // namespace
}  // namespace chromeball::solve_points_test

// SPDX-License-Identifier: Apache-2.0
// The rotation between two probes of one place: known ones are found, and doubtful ones reported as
// such.
#include "probe/capture/align.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "shared_data.h"
#include "sphere_test.h"

namespace chromeball::align_test {
namespace {

using glm::dvec3;

// Smooth, without a symmetry, and of a high range: lobes of random directions, widths and colours.
dvec3 lobes(const dvec3& d) {
  dvec3 sum(0.02);
  for (int i = 0; i < 60; ++i) {
    const dvec3 centre(squareToUniformSphere(random2(i, 0, 5)));
    const double sharpness = 20 + 400 * double(random1(i, 2, 5));
    const dvec3 colour(random1(i, 3, 5), random1(i, 4, 5), random1(i, 5, 5));
    sum += colour * std::exp(4 * double(random1(i, 6, 5)) + sharpness * (glm::dot(d, centre) - 1));
  }
  return sum;
}

// The place as seen by a probe with another orientation: `toWorld` maps it to the world.
Image seenTurned(const Rotation& toWorld, int height) {
  return rasterize(Mapping::LatLong, {2 * height, height}, 2,
                   [&](const dvec3& d) { return lobes(toWorld(d)); });
}

Rotation randomRotation(int i) {
  const auto normal = [&](int d) {
    return std::sqrt(-2 * std::log(std::max(double(random1(i, d, 9)), 1e-9))) *
           std::cos(2 * kPiD * double(random1(i, d + 1, 9)));
  };
  return Rotation::ofQuaternion({normal(0), normal(2), normal(4), normal(6)});
}

double degreesBetween(const Rotation& a, const Rotation& b) {
  const double cosine = std::fabs(glm::dot(a.quaternion(), b.quaternion()));
  return glm::degrees(2 * std::acos(std::min(cosine, 1.0)));
}

double texelDegrees(const Image& map) { return 180.0 / map.height; }

TEST(SlowAlign, RotationsOfAllOfSO3AreFoundToAFractionOfATexel) {
  const Image first = seenTurned(Rotation(), 128);
  for (int i = 0; i < 8; ++i) {
    const Rotation expected = i == 0 ? Rotation() : randomRotation(i);
    const Image second = seenTurned(expected, 128);
    const ProbeAlignment found = alignProbes(first, second, "a", "b");
    EXPECT_LT(degreesBetween(found.rotation, expected), 0.02 * texelDegrees(first)) << i;
    EXPECT_GT(found.correlation, 0.99) << i;
    EXPECT_TRUE(found.others.empty()) << i;
  }
}

Image noisy(Image map, double noise, int seed) {
  for (size_t i = 0; i < map.texels.size(); ++i) {
    const double u = double(random1(int(i), 0, uint64_t(seed))) - 0.5;
    map.texels[i] = float(double(map.texels[i]) * std::exp(std::sqrt(12.0) * noise * u));
  }
  return map;
}

// The errors of the angles about the axes, squared and divided by their variances, over trials:
// chi-square distributed with as many degrees of freedom.
TEST(SlowAlign, NoiseGivesTheErrorThatIsStated) {
  constexpr int kTrials = 12;
  double chiSquare = 0;
  for (int i = 0; i < kTrials; ++i) {
    const Rotation expected = randomRotation(100 + i);
    const Image first = noisy(seenTurned(Rotation(), 96), 0.5, 2 * i + 100);
    Image second = noisy(seenTurned(expected, 96), 0.5, 2 * i + 101);
    for (size_t k = 0; k < second.texels.size(); ++k)
      second.texels[k] *= k % 3 == 0 ? 30 : k % 3 == 1 ? 20 : 12;  // exposure and white balance
    const ProbeAlignment found = alignProbes(first, second, "a", "b");
    EXPECT_LT(degreesBetween(found.rotation, expected), 0.2 * texelDegrees(first)) << i;
    const glm::dquat error = found.rotation.quaternion() * glm::conjugate(expected.quaternion());
    const dvec3 turn =
        glm::degrees(2 * std::copysign(1.0, error.w) * dvec3(error.x, error.y, error.z));
    for (int axis = 0; axis < 3; ++axis)
      chiSquare += std::pow(turn[axis] / found.standardErrors[axis], 2);
  }
  // With 36 degrees of freedom, 99.9% of values are between 14 and 72, and the standard errors err
  // by 10%.
  EXPECT_GT(chiSquare, 14 / 1.2);
  EXPECT_LT(chiSquare, 72 * 1.2);
}

TEST(SlowAlign, ResolutionsMayDiffer) {
  const Rotation expected = randomRotation(50);
  const Image first = seenTurned(Rotation(), 256), second = seenTurned(expected, 60);
  const ProbeAlignment found = alignProbes(first, second, "a", "b");
  EXPECT_LT(degreesBetween(found.rotation, expected), 0.05 * texelDegrees(second));
  EXPECT_LT(degreesBetween(alignProbes(second, first, "b", "a").rotation,
                           Rotation::ofQuaternion(glm::conjugate(expected.quaternion()))),
            0.05 * texelDegrees(second));
}

TEST(Align, AConstantMapHasNoOrientation) {
  const Image map = seenTurned(Rotation(), 32), constant = constantProbe({32, 16}, Rgb(3));
  for (const bool isFirst : {true, false}) {
    try {
      alignProbes(isFirst ? constant : map, isFirst ? map : constant, "a.exr", "b.exr");
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()),
                std::string(isFirst ? "a.exr" : "b.exr") +
                    ": has the same radiance in all directions, so no rotation can be found");
    }
  }
}

TEST(SlowAlign, ASkySymmetricAboutAnAxisIsAmbiguousAboutIt) {
  const dvec3 axis = glm::normalize(dvec3(0.3, 0.9, -0.2));
  const Image sky = rasterize(Mapping::LatLong, {128, 64}, 2, [&](const dvec3& d) {
    return dvec3(1, 2, 3) * std::exp(2 * glm::dot(d, axis));
  });
  const ProbeAlignment found = alignProbes(sky, sky, "a", "b");
  EXPECT_GT(found.others.size(), 3u);
  ASSERT_TRUE(found.axis);
  EXPECT_GT(std::fabs(glm::dot(*found.axis, axis)), 0.9999);
}

TEST(Align, ARoomOfTwoEqualHalvesHasTwoAnswers) {
  const auto halves = [](const dvec3& d) { return lobes(d) + lobes({-d.x, d.y, -d.z}); };
  const Image room = rasterize(Mapping::LatLong, {128, 64}, 2, halves);
  const Image turned = rasterize(Mapping::LatLong, {128, 64}, 2, [&](const dvec3& d) {
    return halves(Rotation::ofAngles({20, 30, 40})(d));
  });
  const ProbeAlignment found = alignProbes(room, turned, "a", "b");
  ASSERT_EQ(found.others.size(), 1u);
  EXPECT_NEAR(degreesBetween(found.rotation, found.others[0].rotation), 180, 0.1);
}

// The cross was made from the angular map (both of debevec.org/Probes).
TEST(SlowAlign, GalileosCrossHasTheOrientationOfItsAngularMap) {
  const auto cross = sharedData("probes/debevec/galileo_cross.hdr");
  const auto angular = sharedData("probes/debevec/galileo_probe.hdr");
  if (!cross || !angular) GTEST_SKIP() << "no shared data";
  const Image first = loadProbe(*angular).latLong, second = loadProbe(*cross).latLong;
  const ProbeAlignment found = alignProbes(first, second, "probe", "cross");
  EXPECT_LT(degreesBetween(found.rotation, Rotation()), 0.5 * texelDegrees(second));
  EXPECT_GT(found.correlation, 0.98);
  const Rotation turn = randomRotation(60);
  const Image turned =
      convert(second, Mapping::LatLong, Mapping::LatLong, {second.width, second.height}, turn);
  const ProbeAlignment again = alignProbes(turned, first, "cross", "probe");
  EXPECT_LT(degreesBetween(again.rotation, turn), 0.5 * texelDegrees(second));
}

}  // namespace
}  // namespace chromeball::align_test

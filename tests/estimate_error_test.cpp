// SPDX-License-Identifier: Apache-2.0
// Errors of estimated light by closed forms: on images, and on the three spheres.
#include "measure/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "approximate/probe_spheres.h"
#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/edit.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_scene.h"

namespace chromeball::estimate_error_test {
namespace {

constexpr int kDiameter = 12;

Image sphereMask(int diameter) {
  Image mask(diameter, diameter, 1);
  for (int y = 0; y < diameter; ++y)
    for (int x = 0; x < diameter; ++x) *mask.at(x, y) = isOnSphere(x, y, diameter);
  return mask;
}

std::array<EstimateError, 3> errorsOf(const Image& predicted, const Image& truth) {
  const Image probes[] = {predicted, truth};
  const auto spheres = probeSpheres(probes, kDiameter);
  std::array<EstimateError, 3> errors;
  for (size_t i = 0; i < errors.size(); ++i)
    errors[i] = estimateError(spheres[i][0], spheres[i][1], sphereMask(kDiameter));
  return errors;
}

Image studioWithSlope() {
  Image map = studioProbe({64, 32});
  const Image slope = gradientProbe({64, 32}, Rgb(0.2f, 0.3f, 0.4f), {0.5, 0.3, -0.6});
  for (size_t i = 0; i < map.texels.size(); ++i) map.texels[i] += slope.texels[i];
  return map;
}

// Two pixels count; one of them is black in one image and has no angle.
TEST(EstimateError, AgreesWithNumbersComputedByHand) {
  Image predicted(3, 1, 3), truth(3, 1, 3), mask(3, 1, 1);
  mask.texels = {1, 1, 0};
  predicted.texels = {1, 0, 0, 0, 0, 0, 9, 9, 9};
  truth.texels = {1, 1, 0, 0, 2, 0, 1, 2, 3};
  const EstimateError error = estimateError(predicted, truth, mask);
  EXPECT_NEAR(error.rmse, std::sqrt((1 + 4) / 6.), 1e-12);
  EXPECT_NEAR(error.scale, 1, 1e-12);  // sum p t = 1, sum p^2 = 1
  EXPECT_NEAR(error.scaleInvariantRmse, std::sqrt(5 / 6.), 1e-12);
  EXPECT_NEAR(error.angularError, 45, 1e-12);
  EXPECT_TRUE(std::isnan(estimateError(Image(3, 1, 3), truth, mask).angularError));
  EXPECT_NEAR(estimateError(Image(3, 1, 3), truth, mask).scaleInvariantRmse, 1, 1e-12);
}

TEST(EstimateError, EqualProbesHaveNone) {
  const Image probe = studioWithSlope();
  for (const EstimateError& error : errorsOf(probe, probe)) {
    EXPECT_EQ(error.rmse, 0);
    EXPECT_NEAR(error.angularError, 0, 1e-10);
    EXPECT_NEAR(error.scaleInvariantRmse, 0, 1e-6);
    EXPECT_NEAR(error.scale, 1, 1e-12);
  }
}

// With predicted = k true: RMSE = |k - 1| rms(true), and nothing else.
TEST(EstimateError, ScaledProbesDifferInRmseAlone) {
  constexpr float kFactor = 3;
  const Image truth = studioWithSlope();
  Image predicted = truth;
  multiply(predicted, Rgb(kFactor));
  const auto none = errorsOf(Image(64, 32, 3), truth);  // its RMSE is rms(true)
  const auto errors = errorsOf(predicted, truth);
  for (size_t i = 0; i < errors.size(); ++i) {
    EXPECT_NEAR(errors[i].rmse / none[i].rmse, kFactor - 1, 1e-5);
    EXPECT_NEAR(errors[i].scale, 1 / kFactor, 1e-6);
    EXPECT_LT(errors[i].scaleInvariantRmse, 1e-5 * none[i].rmse);
    EXPECT_LT(errors[i].angularError, 1e-4);
  }
}

// White light w and predicted light of colour c: each pixel is that of white light times c, so that
// the angle is the one between c and (1, 1, 1), and the best factor sum c / sum c^2.
TEST(EstimateError, ColourCastsTurnColours) {
  const Rgb cast(1.5f, 1, 0.25f);
  const auto errors = errorsOf(constantProbe({64, 32}, cast), constantProbe({64, 32}, Rgb(1)));
  const double sum = 2.75, squares = 1.5 * 1.5 + 1 + 0.25 * 0.25;
  for (const EstimateError& error : errors) {
    EXPECT_NEAR(error.angularError, glm::degrees(std::acos(sum / std::sqrt(3 * squares))), 1e-4);
    EXPECT_NEAR(error.scale, sum / squares, 1e-5);
  }
  // The radiance of these two is the reflectance times that of the light, 0.8.
  for (const EstimateError& error : {errors[0], errors[2]}) {
    EXPECT_NEAR(error.rmse, 0.8 * std::sqrt((0.25 + 0.75 * 0.75) / 3), 2e-4);
    EXPECT_NEAR(error.scaleInvariantRmse, 0.8 * std::sqrt(1 - sum * sum / squares / 3), 2e-4);
  }
}

// Light from one side lights that side, and a ball mirrors what is behind the camera in its middle.
TEST(ProbeSpheres, ShowTheRightDirections) {
  const auto middle = [](const Image& image) { return image.rgb(kDiameter / 2, kDiameter / 2).x; };
  const auto sides = [](const Image& image) {
    return image.rgb(kDiameter - 4, kDiameter / 2).x - image.rgb(3, kDiameter / 2).x;
  };
  const auto ends = [](const Image& image) {
    return image.rgb(kDiameter / 2, 3).x - image.rgb(kDiameter / 2, kDiameter - 4).x;
  };
  for (const auto& [axis, shows] :
       {std::pair<dvec3, std::function<float(const Image&)>>{{0.9, 0, 0}, sides},
        {{0, 0.9, 0}, ends},
        {{0, 0, 0.9}, [&](const Image& image) { return middle(image) - 0.8f; }}}) {
    const Image probe = gradientProbe({64, 32}, Rgb(1), axis);
    for (const SphereImages& sphere : probeSpheres(std::span(&probe, 1), kDiameter))
      EXPECT_GT(shows(sphere[0]), 0.1) << axis.x << axis.y << axis.z;
  }
}

// The path tracer's picture of a sphere of the same material. (At the rim its mesh is a polygon,
// and its mirror reflects more, by Schlick's term.)
TEST(SlowProbeSpheres, AgreeWithThePathTracer) {
  constexpr int kSize = 32;
  const Image map = studioWithSlope();
  const Probe probe(map);
  const auto spheres = probeSpheres(std::span(&map, 1), kSize);
  Camera camera;
  camera.position = {0, 0, 5};
  camera.orthographic = true;
  for (size_t i = 0; i < spheres.size(); ++i) {
    Material material = lambert(Rgb(kSphereReflectance));
    if (i > 0) {
      material.metallic = 1;
      material.roughness = i == 1 ? kSilverRoughness : 0;
    }
    Scene scene;
    addSphere(scene, addMaterial(scene, material), vec3(0), 1, 64);
    const Image rendered =
        renderScene(scene, camera, probe, "importance", smallRender(kSize, kSize, 256, 1))
            .film.mean();
    Image inner(kSize, kSize, 1);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        *inner.at(x, y) = glm::length(vec2(x + 0.5f, y + 0.5f) / (kSize / 2.0f) - 1.0f) < 0.85f;
    const EstimateError error = estimateError(spheres[i][0], rendered, inner);
    const double rms = estimateError(Image(kSize, kSize, 3), rendered, inner).rmse;
    EXPECT_NEAR(error.scale, 1, 0.01) << kSphereNames[i];
    EXPECT_LT(error.rmse, 0.03 * rms) << kSphereNames[i];
  }
}

TEST(CommandProbeSpheres, WritesTableJsonAndPicture) {
  const TemporaryFolder folder;
  writeImage(folder / "true.exr", constantProbe({16, 8}, Rgb(1)));
  writeImage(folder / "double.exr", constantProbe({16, 8}, Rgb(2)));
  const CommandResult table =
      runCommand({"probe", "spheres", folder / "double.exr", folder / "true.exr", "--size", "8",
                  "-o", folder / "picture.png"});
  EXPECT_EQ(table.status, 0) << table.error;
  for (const char* word : {"diffuse", "matte silver", "mirror", "si-RMSE", "degrees"})
    EXPECT_NE(table.out.find(word), std::string::npos) << table.out;
  // Columns of diffuse spheres: predicted and true are white, the difference is red.
  const Image picture = readImage(folder / "picture.png");
  ASSERT_EQ(picture.width, 3 * 10 + 2);
  EXPECT_GT(picture.rgb(6, 6).z, 0.9);
  EXPECT_GT(picture.rgb(6, 16).z, 0.9);
  EXPECT_GT(picture.rgb(6, 26).x, 2 * picture.rgb(6, 26).z);

  const CommandResult json = runCommand(
      {"probe", "spheres", folder / "double.exr", folder / "true.exr", "--size", "8", "--json"});
  const auto found = nlohmann::json::parse(json.out);
  ASSERT_EQ(found["spheres"].size(), 3u);
  for (const auto& sphere : found["spheres"]) {
    EXPECT_NEAR(double(sphere["scale"]), 0.5, 1e-6);
    EXPECT_NEAR(double(sphere["si_rmse"]), 0, 1e-5);
    EXPECT_GT(double(sphere["rmse"]), 0.7);
  }
  expectError(
      {"probe", "spheres", folder / "double.exr", folder / "true.exr", "-o", folder / "true.exr"},
      "true.exr");
  expectError({"probe", "spheres", folder / "absent.exr", folder / "true.exr"}, "absent.exr");
}

}  // namespace
}  // namespace chromeball::estimate_error_test

// SPDX-License-Identifier: Apache-2.0
// Prefiltered maps: closed forms, a direct sum, irradiance and harmonics.
#include "probe/convolve.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::convolve_test {
namespace {

const std::vector<ZonalKernel> kKernels{ZonalKernel::phong(1),   ZonalKernel::phong(20),
                                        ZonalKernel::phong(5e3), ZonalKernel::ggx(0.05),
                                        ZonalKernel::ggx(0.4),   ZonalKernel::ggx(1)};

// The direct sum, with each texel divided into `parts`^2.
dvec3 directSum(const Image& map, const ZonalKernel& kernel, const dvec3& axis, int parts) {
  dvec3 sum(0);
  double weight = 0;
  const ImageSize fine{map.width * parts, map.height * parts};
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      const double w = texelSolidAngle(y, fine.width, fine.height) *
                       kernel.at(glm::dot(axis, texelDirection(fine, x, y))).value;
      sum += w * dvec3(map.rgb(x / parts, y / parts));
      weight += w;
    }
  return sum / weight;
}

TEST(SlowConvolve, AConstantMapKeepsItsValue) {
  for (const ImageSize& size : {ImageSize{1, 1}, {5, 3}, {256, 128}}) {
    const Image map = constantProbe(size, Rgb(1e-8f, 1, 1e10f));
    for (const ZonalKernel& kernel : kKernels)
      for (const dvec3& mean : convolve(map, kernel, texelDirections({8, 4}))) {
        const double tolerance = kernel.isCosine() ? 6e-5 : 1e-6;
        EXPECT_NEAR(mean.x, 1e-8, 1e-8 * tolerance);
        EXPECT_NEAR(mean.y, 1, tolerance);
        EXPECT_NEAR(mean.z, 1e10, 1e10 * tolerance);
      }
  }
}

// Accurate to the difference between the gradient and constant texels of 1.4 degrees. 1 + s . d
// becomes 1 + (n + 1) / (n + 2) s . d under a Phong lobe of exponent n.
TEST(Convolve, OfAGradientHasAClosedForm) {
  const dvec3 s(0.3, -0.2, 0.5);
  const Image map = gradientProbe({256, 128}, Rgb(1), s);
  const std::vector<vec3> axes = texelDirections({8, 4});
  for (const ZonalKernel& kernel : kKernels) {
    const auto moments = kernel.legendreMoments();
    const double factor = moments[1] / moments[0];
    const std::vector<dvec3> means = convolve(map, kernel, axes);
    for (size_t i = 0; i < axes.size(); ++i)
      EXPECT_NEAR(means[i].x, 1 + factor * glm::dot(s, dvec3(axes[i])), 5e-4);
  }
  for (const double n : {1.0, 7.0, 1e4}) {
    const auto moments = ZonalKernel::phong(n).legendreMoments();
    EXPECT_NEAR(moments[1] / moments[0], (n + 1) / (n + 2), 1e-12);
    EXPECT_NEAR(moments[0], 2 * kPiD / (n + 1), 1e-12);
  }
}

// 4 pi times the integral over t = (1 - cos) / 2 in [0, 1/2] of (1 - 2 t) / (1 + b t)^2, with
// b = 1 / alpha^2 - 1.
TEST(Convolve, IntegralOfGgxHasAClosedForm) {
  for (const double roughness : {0.01, 0.1, 0.5, 0.9}) {
    const double b = std::pow(roughness, -4) - 1;
    const double exact = 4 * kPiD * (b - 2 * std::log1p(b / 2)) / (b * b);
    EXPECT_NEAR(ZonalKernel::ggx(roughness).integral() / exact, 1, 1e-9) << roughness;
  }
}

// They agree to the accuracy that convolve() states.
TEST(Convolve, AgreesWithTheDirectSum) {
  Image map = studioProbe({96, 48});
  map.setRgb(40, 12, Rgb(1e4f, 9e3f, 7e3f));  // a sun
  for (const ZonalKernel& kernel : kKernels)
    for (const dvec3& d : {dvec3(0, 1, 0), dvec3(0.6, 0.64, 0.48), dvec3(-0.8, -0.36, 0.48)}) {
      const vec3 axis[] = {vec3(d)};
      const dvec3 found = convolve(map, kernel, axis)[0], truth = directSum(map, kernel, d, 12);
      const double scale = glm::length(truth) + glm::length(meanRadiance(map));
      EXPECT_LT(glm::distance(found, truth), 1e-3 * scale) << kernel.width();
    }
}

// All light from one texel: the kernel itself, by any rectangle that holds it. Never below 0.
TEST(Convolve, OfOneTexelIsTheKernel) {
  constexpr ImageSize kSize{512, 256};
  constexpr int kX = 90, kY = 70, kParts = 8;
  Image map(kSize.width, kSize.height, 3);
  map.setRgb(kX, kY, Rgb(1e4f));
  const double flux = 1e4 * texelSolidAngle(kY, kSize.width, kSize.height);
  const std::vector<vec3> axes = texelDirections({24, 12});
  for (const ZonalKernel& kernel :
       {ZonalKernel::ggx(0.2), ZonalKernel::ggx(0.5), ZonalKernel::ggx(0.95),
        ZonalKernel::phong(1.5), ZonalKernel::phong(50)}) {
    const std::vector<dvec3> means = convolve(map, kernel, axes);
    double worst = 0;
    for (size_t i = 0; i < axes.size(); ++i) {
      double value = 0, weight = 0;
      const ImageSize fine{kSize.width * kParts, kSize.height * kParts};
      for (int k = 0; k < kParts * kParts; ++k) {
        const int x = kX * kParts + k % kParts, y = kY * kParts + k / kParts;
        const double w = texelSolidAngle(y, fine.width, fine.height);
        value += w * kernel.at(glm::dot(dvec3(axes[i]), dvec3(texelDirection(fine, x, y)))).value;
        weight += w;
      }
      const double exact = value / weight * flux / kernel.integral(), mean = flux / (4 * kPiD);
      worst = std::max(worst, std::fabs(means[i].x - exact) / (exact + mean));
      EXPECT_GE(means[i].x, 0);
    }
    EXPECT_LT(worst, 2e-3);
  }
}

TEST(Convolve, ByACosineIsIrradianceOverPi) {
  const Image map = studioProbe({256, 128});
  const std::vector<vec3> axes = texelDirections({24, 12});
  const std::vector<dvec3> exact = exactIrradiance(map, axes);
  dvec3 mean(0);
  for (const dvec3& e : exact) mean += e / kPiD / double(exact.size());
  // The last of them uses the general sums.
  for (const ZonalKernel& kernel :
       {ZonalKernel::phong(1), ZonalKernel::ggx(1), ZonalKernel::phong(1.00001)}) {
    const std::vector<dvec3> found = convolve(map, kernel, axes);
    for (size_t i = 0; i < axes.size(); ++i)
      EXPECT_LT(glm::distance(found[i], exact[i] / kPiD), 1e-3 * glm::length(mean)) << i;
  }
}

// A lamp at the horizon of the lobe, where the kernel rises slowly.
TEST(SlowConvolve, ByWideLobesKeepsLightNearTheirHorizon) {
  Image map = constantProbe({128, 64}, Rgb(0.05f));
  for (int y = 20; y < 24; ++y)
    for (int x = 60; x < 64; ++x) map.setRgb(x, y, Rgb(50));
  const std::vector<vec3> axes = texelDirections({16, 8});
  for (const double n : {1.5, 2.0, 2.5, 3.0, 5.0}) {
    const ZonalKernel kernel = ZonalKernel::phong(n);
    const std::vector<dvec3> found = convolve(map, kernel, axes);
    double mean = 0;
    for (const dvec3& f : found) mean += f.x / double(found.size());
    for (size_t i = 0; i < axes.size(); ++i)
      EXPECT_NEAR(found[i].x, directSum(map, kernel, axes[i], 4).x, 2e-3 * mean) << n << ' ' << i;
  }
}

TEST(Convolve, ByANarrowKernelIsTheMap) {
  const Image map = studioProbe({64, 32});
  const std::vector<vec3> axes = texelDirections({64, 32});
  for (size_t i = 0; i < axes.size(); i += 37) {
    const dvec3 found = convolve(map, ZonalKernel::phong(1e8), {&axes[i], 1})[0];
    const dvec3 texel(map.rgb(int(i) % 64, int(i) / 64));
    EXPECT_LT(glm::distance(found, texel), 1e-4 * (1 + glm::length(texel))) << i;
  }
}

TEST(Convolve, ByHarmonicsIsThatOfIrradiance) {
  const Image map = studioProbe({128, 64});
  const std::vector<vec3> axes = texelDirections({8, 4});
  const std::vector<dvec3> irradiance = shIrradiance(map, axes),
                           means = shConvolve(map, ZonalKernel::phong(1), axes);
  for (size_t i = 0; i < axes.size(); ++i)
    EXPECT_LT(glm::distance(means[i], irradiance[i] / kPiD), 1e-6 * glm::length(means[i]));
}

TEST(Convolve, SlopesAndCurvaturesAreDerivatives) {
  for (const ZonalKernel& kernel : kKernels)
    for (const double cosine : {0.2, 0.7, 0.99}) {
      constexpr double kStep = 1e-5;
      const ZonalKernel::Value k = kernel.at(cosine), before = kernel.at(cosine - kStep),
                               after = kernel.at(cosine + kStep);
      // Central differences err by a sixth of the third derivative times the square of the step.
      EXPECT_NEAR((after.value - before.value) / (2 * kStep), k.slope, 1e-3 * k.slope + 1e-9);
      EXPECT_NEAR((after.slope - before.slope) / (2 * kStep), k.curvature,
                  1e-3 * k.curvature + 1e-9);
    }
}

TEST(Convolve, KernelsOutsideTheirRangeAreRejected) {
  for (const double n : {0.0, 0.5, -1.0, 1e9, std::nan("")})
    EXPECT_THROW(ZonalKernel::phong(n), InputError) << n;
  for (const double roughness : {0.0, 0.001, 1.1, -1.0, std::nan("")})
    EXPECT_THROW(ZonalKernel::ggx(roughness), InputError) << roughness;
}

}  // namespace
}  // namespace chromeball::convolve_test

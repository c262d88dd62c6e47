// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/sun_from_ball.h"

#include <cmath>

#include "base/error.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

// Of a white ball in the light of the probe, at each sample.
std::vector<dvec3> radianceOf(const Image& probe, const BallSamples& ball) {
  std::vector<vec3> normals;
  normals.reserve(ball.samples.size());
  for (const BallSample& sample : ball.samples) normals.push_back(sample.normal);
  std::vector<dvec3> radiance = exactIrradiance(probe, normals);
  for (dvec3& r : radiance) r /= kPiD;
  return radiance;
}

dvec3 meanOf(const std::vector<dvec3>& values) {
  dvec3 sum(0);
  for (const dvec3& value : values) sum += value;
  return sum / double(values.size());
}

double rmsOf(const std::vector<dvec3>& values) {
  double sum = 0;
  for (const dvec3& value : values) sum += glm::dot(value, value);
  return std::sqrt(sum / (3 * double(values.size())));
}

}  // namespace

SunFromBall solveSun(const Image& clipped, const BallSamples& ball, const dvec3& direction,
                     double angle) {
  constexpr double kLeastLit = 0.01;
  const size_t count = ball.samples.size();
  const std::vector<dvec3> fromProbe = radianceOf(clipped, ball);
  const Sun test{direction, dvec3(kPiD), angle};
  std::vector<dvec3> real(count), fromSun(count), fromTest(count);
  for (size_t i = 0; i < count; ++i) {
    real[i] = ball.samples[i].radiance;
    fromSun[i] = real[i] - fromProbe[i];
    fromTest[i] = test.irradianceOn(dvec3(ball.samples[i].normal)) / kPiD;
  }
  if (!(meanOf(fromTest).x > kLeastLit))
    throwInput(
        "--direction: the sun at {:.3f} {:.3f} {:.3f} lights less than the rim of what --camera "
        "sees of the ball",
        direction.x, direction.y, direction.z);

  SunFromBall result{.sun = test, .alpha = meanOf(fromSun) / meanOf(fromTest)};
  if (!(std::min({result.alpha.x, result.alpha.y, result.alpha.z}) > 0))
    throwInput(
        "--diffuse: the ball is darker than the probe alone lights it: {:.4g} {:.4g} {:.4g} of its "
        "mean; do both have the same exposure, and is --paint right?",
        (meanOf(fromSun) / meanOf(real)).x, (meanOf(fromSun) / meanOf(real)).y,
        (meanOf(fromSun) / meanOf(real)).z);
  result.sun.irradiance = kPiD * result.alpha;

  const double mean = glm::dot(meanOf(real), dvec3(1)) / 3;
  std::vector<dvec3> residual(count);
  size_t explained = 0;
  result.residual = Image(ball.side, ball.side, 3);
  for (size_t i = 0; i < count; ++i) {
    residual[i] = fromSun[i] - result.alpha * fromTest[i];
    const dvec3 size = glm::abs(residual[i]);
    explained += std::max({size.x, size.y, size.z}) <= kExplained * mean;
    result.residual.setRgb(ball.samples[i].x, ball.samples[i].y, Rgb(residual[i]));
  }
  result.rmsOfProbe = rmsOf(fromSun) / mean;
  result.rms = rmsOf(residual) / mean;
  result.explained = double(explained) / double(count);
  return result;
}

}  // namespace chromeball

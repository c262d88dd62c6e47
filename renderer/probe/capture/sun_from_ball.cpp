// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/sun_from_ball.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "image/io/read_image.h"
#include "probe/convert.h"
#include "probe/irradiance.h"
#include "probe/solid_angle.h"
#include "probe/sun_extraction.h"

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
        "direction: the sun at {:.3f} {:.3f} {:.3f} lights less than the rim of what the camera "
        "sees of the ball",
        direction.x, direction.y, direction.z);

  SunFromBall result{.sun = test, .alpha = meanOf(fromSun) / meanOf(fromTest)};
  if (!(std::min({result.alpha.x, result.alpha.y, result.alpha.z}) > 0))
    throwInput(
        "the diffuse ball is darker than the probe alone lights it: {:.4g} {:.4g} {:.4g} of its "
        "mean; do both have the same exposure, and is the paint right?",
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

namespace {

constexpr float kPlateau = 0.98f;

// Three channels: 1 where the probe shows as much as it can, else 0.
Image marked(const Image& latLong, const Image* clipped) {
  float maximum = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      maximum = std::max(maximum, luminance(latLong.rgb(x, y)));
  Image marks(latLong.width, latLong.height, 3);
  for (int y = 0; y < marks.height; ++y)
    for (int x = 0; x < marks.width; ++x) {
      const bool isMarked = clipped
                                ? *clipped->at(x, y) > 0.5f
                                : maximum > 0 && luminance(latLong.rgb(x, y)) >= kPlateau * maximum;
      marks.setRgb(x, y, Rgb(isMarked ? 1 : 0));
    }
  return marks;
}

struct Region {
  std::vector<Texel> texels;
  double solidAngle = 0;
};

std::vector<Region> regionsOf(const Image& marks) {
  std::vector<bool> visited(size_t(marks.width) * marks.height);
  std::vector<Region> regions;
  for (int y = 0; y < marks.height; ++y)
    for (int x = 0; x < marks.width; ++x) {
      Region region{gatherRegion(marks, {x, y}, 0.5, visited)};
      if (region.texels.empty()) continue;
      for (const Texel t : region.texels)
        region.solidAngle += texelSolidAngle(t.y, marks.width, marks.height);
      regions.push_back(std::move(region));
    }
  return regions;
}

}  // namespace

std::optional<Image> loadClippedLayer(const std::filesystem::path& path, const LoadedProbe& probe) {
  if (lowerExtension(path) != ".exr") return std::nullopt;
  const std::optional<Image> layer = layerOf(readImageFile(path), "clipped", path);
  if (!layer) return std::nullopt;
  Image marks(layer->width, layer->height, 3);
  for (int y = 0; y < marks.height; ++y)
    for (int x = 0; x < marks.width; ++x) marks.setRgb(x, y, Rgb(*layer->at(x, y) > 0.5f ? 1 : 0));
  const Image map = convert(marks, probe.mapping, Mapping::LatLong,
                            {probe.latLong.width, probe.latLong.height}, probe.turned ? 180 : 0);
  Image clipped(map.width, map.height, 1);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) *clipped.at(x, y) = map.rgb(x, y).x;
  return clipped;
}

ClippedSun findClippedSun(const Image& latLong, const Image* clipped, const std::string& name) {
  const Image marks = marked(latLong, clipped);
  const std::vector<Region> regions = regionsOf(marks);
  if (regions.empty())
    throwInput("{}: {}; give the direction", name,
               clipped ? "its layer `clipped` marks no texel" : "is black");
  const auto bySize = [](const Region& a, const Region& b) { return a.solidAngle < b.solidAngle; };
  const Region& largest = *std::ranges::max_element(regions, bySize);

  const ImageSize size{marks.width, marks.height};
  dvec3 sum(0);
  for (const Texel t : largest.texels)
    sum += texelDirection(size, t.x, t.y) * texelSolidAngle(t.y, size.width, size.height);
  if (!(glm::length(sum) > 0.1 * largest.solidAngle))
    throwInput("{}: what is as bright as it can show surrounds the viewer; give the direction",
               name);
  ClippedSun sun{glm::normalize(sum), 180.0 / size.height};
  double furthest = 0;  // half of the chord
  for (const Texel t : largest.texels)
    furthest = std::max(furthest, glm::distance(sun.direction, texelDirection(size, t.x, t.y)) / 2);
  sun.width += 4 * std::asin(std::min(furthest, 1.0)) * 180 / kPiD;
  sun.rivals = size_t(std::ranges::count_if(regions,
                                            [&](const Region& region) {
                                              return region.solidAngle >= largest.solidAngle / 2;
                                            })) -
               1;
  return sun;
}

}  // namespace chromeball

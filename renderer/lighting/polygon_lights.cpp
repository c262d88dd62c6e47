// SPDX-License-Identifier: Apache-2.0
#include "lighting/polygon_lights.h"

#include <limits>

#include "base/hash.h"

namespace chromeball {
namespace {

constexpr uint64_t kPolygonSet = uint64_t(2) << 32;  // apart from the discs of suns.h

SphericalPolygon turned(const SphericalPolygon& polygon, const Rotation& rotation) {
  std::vector<dvec3> corners;
  for (const dvec3& corner : polygon.corners()) corners.push_back(rotation(corner));
  return {corners, "polygon"};
}

}  // namespace

PolygonLights::PolygonLights(const std::vector<PolygonLight>& lights, const Image& hidden,
                             const Rotation& rotation)
    : choice_(1, int(lights.size())), hidden_(hidden, rotation) {
  std::vector<double> powers;
  for (const PolygonLight& light : lights)
    powers.push_back(luminance(Rgb(light.source.irradiance())));
  const double total = choice_.setRow(0, powers);
  for (size_t i = 0; i < lights.size(); ++i) {
    const PolygonSource& source = lights[i].source;
    const double probability = total > 0 ? powers[i] / total : 0;
    lights_.push_back({turned(source.polygon, rotation), Rgb(source.radiance), lights[i].isIllum,
                       lights[i].name, float(probability / source.polygon.solidAngle())});
  }
}

void PolygonLights::sample(const LightPoint& point, const PixelSampler& sampler,
                           std::vector<DirectionSample>& out) const {
  if (areBlack()) return;
  const auto [chosen, wi] =
      choose(toUnit(sampler.bits(dimension::kLight) ^ uint32_t(hash(kPolygonSet))),
             toUnit(sampler.bits(dimension::kLight + 1) ^ uint32_t(hash(kPolygonSet + 1))));
  const Light& light = lights_[chosen];
  if (light.isIllum) {
    out.push_back({wi, light.radiance / light.pdf, light.pdf, true, int(chosen)});
    return;
  }
  const Escaped found = escaped(point, wi);
  if (found.pdf > 0) out.push_back({wi, found.radiance / found.pdf, found.pdf});
}

PolygonLights::Chosen PolygonLights::choose(double u, float v) const {
  const size_t light = size_t(choice_.sample(0, u));
  return {light, vec3(lights_[light].polygon.sample(u, v))};
}

bool PolygonLights::sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const {
  out.pdf = 0;
  if (areBlack()) return true;
  const Chosen chosen = choose(toUnit(numbers.x), toUnit(numbers.y));
  const Light& light = lights_[chosen.light];
  out = {chosen.wi, light.radiance / light.pdf, light.pdf};
  return true;
}

LightSource::Escaped PolygonLights::escaped(const LightPoint&, const vec3& wi) const {
  Escaped sum{Rgb(0), 0};
  for (const Light& light : lights_)
    if (!light.isIllum && light.polygon.contains(dvec3(wi))) sum += {light.radiance, light.pdf};
  return sum;
}

Rgb PolygonLights::background(const vec3&, const vec3& wi) const {
  Rgb sum = hidden_.radiance(wi);
  for (const Light& light : lights_)
    if (!light.isIllum && light.polygon.contains(dvec3(wi))) sum += light.radiance;
  return sum;
}

std::vector<std::string> PolygonLights::groups() const {
  std::vector<std::string> names;
  for (const Light& light : lights_) names.push_back(light.name);
  return names;
}

void PolygonLights::splitEscaped(const LightPoint&, const vec3& wi,
                                 std::span<Rgb> radiances) const {
  for (size_t i = 0; i < lights_.size(); ++i)
    if (!lights_[i].isIllum && lights_[i].polygon.contains(dvec3(wi)))
      radiances[i] += lights_[i].radiance;
}

void PolygonLights::splitBackground(const vec3&, const vec3& wi, std::span<Rgb> radiances) const {
  splitEscaped({}, wi, radiances);
  if (const Rgb hidden = hidden_.radiance(wi); !isBlack(hidden)) radiances[illumAt(wi)] += hidden;
}

// The illum that took the hidden light in this direction: the first that contains it; at its rim,
// where texels reach over the edge, the nearest.
size_t PolygonLights::illumAt(const vec3& wi) const {
  size_t nearest = 0;
  double least = std::numeric_limits<double>::max();
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (!lights_[i].isIllum) continue;
    const double distance = lights_[i].polygon.chordTo(dvec3(wi));
    if (distance < least) least = distance, nearest = i;
  }
  return nearest;
}

}  // namespace chromeball

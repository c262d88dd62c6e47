// SPDX-License-Identifier: Apache-2.0
#include "lighting/area_lights.h"

#include "base/hash.h"

namespace chromeball {

AreaLights::AreaLights(const Probe& probe, std::unique_ptr<const LightAreas> areas)
    : probe_(probe),
      areas_(std::move(areas)),
      choice_(1, std::max(1, int(areas_->lights().size()))) {
  std::vector<double> powers;
  for (const AreaLight& light : areas_->lights()) powers.push_back(luminance(light.power));
  if (!powers.empty()) power_ = choice_.setRow(0, powers);
}

float AreaLights::pdf(const LightAreas::Found& found, int depth) const {
  if (samplesAll(depth)) return found.density;
  // Of each light, power / (all power) x 1 / solid angle: in proportion to its radiance.
  return float(kLater * luminance(glm::dvec3(found.radiance)) / power_);
}

void AreaLights::sample(const LightPoint& point, const PixelSampler& sampler,
                        std::vector<DirectionSample>& out) const {
  if (!(power_ > 0)) return;
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  const auto append = [&](size_t light, double s, double t) {
    const LightAreas::Sample at = areas_->sample(light, s, t);
    if (const float density = pdf(at.found, point.depth); density > 0)
      out.push_back({at.direction, at.found.radiance / density, density});
  };
  if (!samplesAll(point.depth)) {
    for (int k = 0; k < kLater; ++k) {
      double choice = (k + u * 0x1p-32) / kLater;
      const int light = choice_.sample(0, choice);
      append(size_t(light), choice, v * 0x1p-32);
    }
    return;
  }
  // All lights use the same stratified point, with a different digital shift in each.
  for (size_t light = 0; light < areas_->lights().size(); ++light) {
    const uint64_t shift = hash(uint64_t(light));
    append(light, (u ^ uint32_t(shift)) * 0x1p-32, (v ^ uint32_t(shift >> 32)) * 0x1p-32);
  }
}

LightSource::Escaped AreaLights::escaped(const LightPoint& point, const vec3& wi) const {
  if (!(power_ > 0)) return {Rgb(0), 0};
  const LightAreas::Found found = areas_->at(wi);
  return {found.radiance, pdf(found, point.depth)};
}

std::vector<std::string> AreaLights::groups() const {
  std::vector<std::string> names;
  for (size_t i = 0; i < areas_->lights().size(); ++i) names.push_back(std::to_string(i));
  names.push_back("background");
  return names;
}

float AreaLights::mirrorAlpha() const {
  return areas_->lights().empty() ? 0 : 1 / std::sqrt(float(areas_->lights().size()));
}

}  // namespace chromeball

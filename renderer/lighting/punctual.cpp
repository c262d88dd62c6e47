// SPDX-License-Identifier: Apache-2.0
#include "lighting/punctual.h"

namespace chromeball {
namespace {

float rangeAttenuation(const PunctualLight& light, float distance) {
  const float fraction = distance / light.range;
  return std::clamp(1 - fraction * fraction * fraction * fraction, 0.0f, 1.0f);
}

float coneAttenuation(const PunctualLight& light, const vec3& direction, const vec3& wi) {
  const vec3 chord = direction + wi;
  const float cone = glm::dot(chord, chord) / 2;  // 1 - cos, without cancellation near the axis
  if (cone <= light.innerCone) return 1;
  if (cone >= light.outerCone) return 0;
  const float fraction = (light.outerCone - cone) / (light.outerCone - light.innerCone);
  return fraction * fraction;
}

}  // namespace

DirectionSample incidentLight(const PunctualLight& light, const vec3& position, float time) {
  const LampPose pose = light.poseAt(time);
  if (light.kind == PunctualLight::Kind::Directional)
    return {-pose.direction, light.intensity, 0, true};
  const vec3 to = pose.position - position;
  const float distance = glm::length(to);
  if (!(distance > 0)) return {-pose.direction, Rgb(0), 0, true, 0, 0};
  const vec3 wi = to / distance;
  float attenuation = rangeAttenuation(light, distance) / (distance * distance);
  if (light.kind == PunctualLight::Kind::Spot)
    attenuation *= coneAttenuation(light, pose.direction, wi);
  return {wi, light.intensity * attenuation, 0, true, 0, distance};
}

std::unique_ptr<PunctualLights> PunctualLights::make(const Scene& scene) {
  if (scene.lights.empty()) return nullptr;
  return std::unique_ptr<PunctualLights>(new PunctualLights(scene));
}

std::vector<std::string> PunctualLights::groups() const {
  std::vector<std::string> names;
  for (const PunctualLight& light : lights_) names.push_back(light.name);
  return names;
}

DirectionSample PunctualLights::sampleOf(size_t i, const LightPoint& point) const {
  DirectionSample s = incidentLight(lights_[i], point.position, point.time);
  s.group = int(i);
  return s;
}

void PunctualLights::sample(const LightPoint& point, const PixelSampler& sampler,
                            std::vector<DirectionSample>& out) const {
  const size_t wanted = point.depth == 0 ? kFirst : kLater;
  if (lights_.size() > wanted) return choose(point, sampler, int(wanted), out);
  for (size_t i = 0; i < lights_.size(); ++i)
    if (const DirectionSample s = sampleOf(i, point); !isBlack(s.irradiance)) out.push_back(s);
}

void PunctualLights::choose(const LightPoint& point, const PixelSampler& sampler, int count,
                            std::vector<DirectionSample>& out) const {
  float total = 0;
  for (const PunctualLight& light : lights_)
    total += luminance(incidentLight(light, point.position, point.time).irradiance);
  const float step = total / float(count);
  constexpr uint64_t kPurpose = 0x6c616d70;  // separate random stream
  float target = step * toUnit(uint32_t(hash(sampler.sampleKey(), kPurpose))), sum = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    DirectionSample s = sampleOf(i, point);
    const float weight = luminance(s.irradiance);
    sum += weight;
    s.irradiance *= step / weight;
    for (; weight > 0 && sum > target; target += step) out.push_back(s);
  }
}

}  // namespace chromeball

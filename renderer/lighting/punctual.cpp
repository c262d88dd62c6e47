// SPDX-License-Identifier: Apache-2.0
#include "lighting/punctual.h"

namespace chromeball {
namespace {

float rangeAttenuation(const PunctualLight& light, float distance) {
  const float fraction = distance / light.range;
  return std::clamp(1 - fraction * fraction * fraction * fraction, 0.0f, 1.0f);
}

// Minimum of cosInner - cosOuter, as in the extension's example code: avoids division by 0.
constexpr float kMinConeWidth = 0.001f;

float coneAttenuation(const PunctualLight& light, const vec3& wi) {
  const float width = std::max(kMinConeWidth, light.cosInner - light.cosOuter);
  const float fraction = (glm::dot(light.direction, -wi) - light.cosOuter) / width;
  const float clamped = std::clamp(fraction, 0.0f, 1.0f);
  return clamped * clamped;
}

}  // namespace

PunctualSample incidentLight(const PunctualLight& light, const vec3& position) {
  if (light.kind == PunctualLight::Kind::Directional)
    return {-light.direction, INFINITY, light.intensity};
  const vec3 to = light.position - position;
  const float distance = glm::length(to);
  if (!(distance > 0)) return {-light.direction, 0, Rgb(0)};
  const vec3 wi = to / distance;
  float attenuation = rangeAttenuation(light, distance) / (distance * distance);
  if (light.kind == PunctualLight::Kind::Spot) attenuation *= coneAttenuation(light, wi);
  return {wi, distance, light.intensity * attenuation};
}

std::unique_ptr<PunctualLights> PunctualLights::make(const Scene& scene) {
  if (scene.lights.empty()) return nullptr;
  return std::unique_ptr<PunctualLights>(new PunctualLights(scene));
}

}  // namespace chromeball

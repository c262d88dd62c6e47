// SPDX-License-Identifier: Apache-2.0
#include "lighting/punctual.h"

namespace chromeball {
namespace {

float fade(const PunctualLight& light, float distance) {
  const float fraction = distance / light.range;
  return std::clamp(1 - fraction * fraction * fraction * fraction, 0.0f, 1.0f);
}

// The extension keeps the cones at least this far apart, so that the edge has a width.
constexpr float kMinEdge = 0.001f;

float cone(const PunctualLight& light, const vec3& wi) {
  const float width = std::max(kMinEdge, light.cosInner - light.cosOuter);
  const float fraction = (glm::dot(light.direction, -wi) - light.cosOuter) / width;
  const float clamped = std::clamp(fraction, 0.0f, 1.0f);
  return clamped * clamped;
}

}  // namespace

PunctualSample shine(const PunctualLight& light, const vec3& position) {
  if (light.kind == PunctualLight::Kind::Directional)
    return {-light.direction, INFINITY, light.intensity};
  const vec3 to = light.position - position;
  const float distance = glm::length(to);
  if (!(distance > 0)) return {-light.direction, 0, Rgb(0)};
  const vec3 wi = to / distance;
  float fraction = fade(light, distance) / (distance * distance);
  if (light.kind == PunctualLight::Kind::Spot) fraction *= cone(light, wi);
  return {wi, distance, light.intensity * fraction};
}

std::unique_ptr<PunctualLights> PunctualLights::make(const Scene& scene) {
  if (scene.lights.empty()) return nullptr;
  return std::unique_ptr<PunctualLights>(new PunctualLights(scene));
}

}  // namespace chromeball

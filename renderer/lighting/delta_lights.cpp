#include "lighting/delta_lights.h"

#include <limits>

namespace chromeball {
namespace {

// In proportion to the light of a Lambertian surface; positive wherever a light shines on any.
float importance(const DirectionSample& light, const vec3& normal) {
  return luminance(light.irradiance) * std::max(glm::dot(light.wi, normal), 0.0f);
}

}  // namespace

DeltaLights::DeltaLights(const Probe& probe, const Constellation& lights, const Rgb& ambient)
    : probe_(probe), ambient_(ambient) {
  const glm::quat turn = glm::angleAxis(glm::radians(probe.rotationDegrees()), vec3(0, 1, 0));
  for (const DirectionalLight& light : lights)
    if (!isBlack(light.irradiance))
      lights_.push_back({glm::normalize(turn * light.direction), light.irradiance,
                         std::numeric_limits<float>::infinity()});
}

void DeltaLights::sample(const LightPoint& point, const PixelSampler& sampler,
                         std::vector<DirectionSample>& out) const {
  if (point.depth == 0 || int(lights_.size()) <= kLater) {
    out.insert(out.end(), lights_.begin(), lights_.end());
    return;
  }
  float total = 0;
  for (const DirectionSample& light : lights_) total += importance(light, point.normal);
  const float step = total / kLater;
  float target = step * sampler.get1(dimension::kLight), sum = 0;
  for (const DirectionSample& light : lights_) {
    const float share = importance(light, point.normal);
    sum += share;
    for (; sum > target; target += step)
      out.push_back({light.wi, light.irradiance * (step / share), light.density});
  }
}

}  // namespace chromeball

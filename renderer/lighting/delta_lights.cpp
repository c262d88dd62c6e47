// SPDX-License-Identifier: Apache-2.0
#include "lighting/delta_lights.h"

#include <limits>

#include "shading/bsdf.h"

namespace chromeball {
namespace {

constexpr float kDelta = std::numeric_limits<float>::infinity();  // pdf of a direction alone

// In proportion to the light of a Lambertian surface, which is positive wherever a plain BSDF is;
// where light may come from behind the normal, in proportion to what the BSDF makes of it.
float importance(const DirectionSample& light, const LightPoint& point) {
  if (point.bsdf && point.bsdf->isExtended()) [[unlikely]]
    return luminance(light.irradiance * point.bsdf->evaluate(light.wi).fCos);
  return luminance(light.irradiance) * std::max(glm::dot(light.wi, point.normal), 0.0f);
}

}  // namespace

DeltaLights::DeltaLights(const Probe& probe, const Constellation& lights, const Rgb& ambient)
    : probe_(probe), ambient_(ambient) {
  const glm::quat turn = glm::angleAxis(glm::radians(probe.rotationDegrees()), vec3(0, 1, 0));
  for (const DirectionalLight& light : lights)
    if (!isBlack(light.irradiance))
      lights_.push_back({glm::normalize(turn * light.direction), light.irradiance, kDelta});
}

void DeltaLights::sample(const LightPoint& point, const PixelSampler& sampler,
                         std::vector<DirectionSample>& out) const {
  if (point.depth == 0 || int(lights_.size()) <= kLater) {
    out.insert(out.end(), lights_.begin(), lights_.end());
    return;
  }
  // First the lights that shine here, with their importance in the pdf's place; then, of these,
  // the chosen ones.
  const size_t first = out.size();
  float total = 0;
  for (const DirectionSample& light : lights_)
    if (const float fraction = importance(light, point); fraction > 0) {
      total += fraction;
      out.push_back({light.wi, light.irradiance, fraction});
    }
  const float step = total / kLater;
  float target = step * sampler.get1(dimension::kLight), sum = 0;
  size_t kept = first;
  for (size_t i = first; i < out.size(); ++i) {
    const float fraction = out[i].pdf;
    int times = 0;
    for (sum += fraction; sum > target; target += step) ++times;
    if (times > 0)
      out[kept++] = {out[i].wi, out[i].irradiance * (float(times) * step / fraction), kDelta};
  }
  out.resize(kept);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/delta_lights.h"

#include "shading/bsdf.h"

namespace chromeball {
namespace {

// Irradiance x cosine, as luminance: positive wherever a plain BSDF reflects light. For layered
// BSDFs, which may transmit light, irradiance x BSDF x cosine.
float importance(const DirectionSample& light, const LightPoint& point) {
  if (point.bsdf && point.bsdf->isLayered()) [[unlikely]]
    return luminance(light.irradiance * point.bsdf->evaluate(light.wi).fCos);
  return luminance(light.irradiance) * std::max(glm::dot(light.wi, point.normal), 0.0f);
}

double smallestSolidAngle() {
  const double chord = 2 * std::sin(ShownLights::kShownDegrees * kPiD / 720);
  return kPiD * chord * chord;
}

std::vector<AreaLight> large(std::vector<AreaLight> lights) {
  for (AreaLight& light : lights)
    light.solidAngle = std::max(light.solidAngle, smallestSolidAngle());
  return lights;
}

}  // namespace

DeltaLights::DeltaLights(const Probe& probe, const Constellation& lights, const Rgb& ambient)
    : ProbeLight(probe), ambient_(ambient), count_(lights.size()) {
  for (size_t i = 0; i < count_; ++i)
    if (const DirectionalLight& light = lights[i]; !isBlack(light.irradiance))
      lights_.push_back(
          {glm::normalize(probe.rotation()(light.direction)), light.irradiance, 0, true, int(i)});
}

std::vector<std::string> DeltaLights::groups() const {
  std::vector<std::string> names;
  for (size_t i = 0; i < count_; ++i) names.push_back(std::to_string(i));
  names.insert(names.end(), {"ambient", "background"});
  return names;
}

void DeltaLights::sample(const LightPoint& point, const PixelSampler& sampler,
                         std::vector<DirectionSample>& out) const {
  if (point.depth == 0 || int(lights_.size()) <= kLater) {
    out.insert(out.end(), lights_.begin(), lights_.end());
    return;
  }
  // Systematic resampling by importance. The candidates are first stored in `out`, with their
  // importance in `pdf`; then the chosen ones overwrite them.
  const size_t first = out.size();
  float total = 0;
  for (const DirectionSample& light : lights_)
    if (const float weight = importance(light, point); weight > 0) {
      total += weight;
      out.push_back({light.wi, light.irradiance, weight, true, light.group});
    }
  const float step = total / kLater;
  float target = step * sampler.get1(dimension::kLight), sum = 0;
  size_t kept = first;
  for (size_t i = first; i < out.size(); ++i) {
    const float weight = out[i].pdf;
    int times = 0;
    for (sum += weight; sum > target; target += step) ++times;
    if (times > 0)
      out[kept++] = {out[i].wi, out[i].irradiance * (float(times) * step / weight), 0, true,
                     out[i].group};
  }
  out.resize(kept);
}

ShownLights::ShownLights(std::unique_ptr<LightSource> strategy, std::vector<AreaLight> lights,
                         const Rgb& ambient)
    : WrappedLight(std::move(strategy)), discs_(large(std::move(lights))), ambient_(ambient) {}

std::vector<AreaLight> shownLights(const Constellation& lights, const Rotation& rotation) {
  std::vector<AreaLight> shown;
  for (const DirectionalLight& light : lights)
    if (!isBlack(light.irradiance))
      shown.push_back(
          {glm::normalize(rotation(light.direction)), light.irradiance, smallestSolidAngle()});
  return shown;
}

}  // namespace chromeball

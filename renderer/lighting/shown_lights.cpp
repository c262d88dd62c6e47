// SPDX-License-Identifier: Apache-2.0
#include "lighting/shown_lights.h"

#include <algorithm>

namespace chromeball {
namespace {

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

ShownLights::ShownLights(std::unique_ptr<LightSource> strategy, std::vector<AreaLight> lights,
                         const Rgb& ambient)
    : strategy_(std::move(strategy)), discs_(large(std::move(lights))), ambient_(ambient) {}

std::vector<AreaLight> shownLights(const Constellation& lights, const Rotation& rotation) {
  std::vector<AreaLight> shown;
  for (const DirectionalLight& light : lights)
    if (!isBlack(light.irradiance))
      shown.push_back(
          {glm::normalize(rotation(light.direction)), light.irradiance, smallestSolidAngle()});
  return shown;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/scene_suns.h"

namespace chromeball {
namespace {

constexpr uint64_t kSet = uint64_t(1) << 32;  // apart from the suns of the strategy `suns`

std::vector<Sun> sunsOf(const std::vector<SunLamp>& lamps, bool onlyVisible) {
  std::vector<Sun> suns;
  for (const SunLamp& lamp : lamps)
    if (lamp.isVisible || !onlyVisible) suns.push_back(lamp.sun);
  return suns;
}

}  // namespace

SceneSuns::SceneSuns(std::unique_ptr<LightingStrategy> strategy, const std::vector<SunLamp>& suns)
    : strategy_(std::move(strategy)), all_(sunsOf(suns, false)), visible_(sunsOf(suns, true)) {}

void SceneSuns::sample(const LightPoint& point, const PixelSampler& sampler,
                       std::vector<DirectionSample>& out) const {
  const size_t before = out.size();
  strategy_->sample(point, sampler, out);
  for (size_t i = before; i < out.size(); ++i) {
    DirectionSample& s = out[i];
    if (s.isDelta) continue;
    const SkyDiscs::Light discs = all_.at(s.wi);
    if (discs.pdf == 0) continue;
    const float pdf = s.pdf + discs.pdf;
    s.irradiance = (s.irradiance * s.pdf + discs.radiance) / pdf;
    s.pdf = pdf;
  }
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  all_.sample(u, v, kSet, [&](const vec3& wi) {
    const Escaped light = escaped(point, wi);
    if (light.pdf > 0) out.push_back({wi, light.radiance / light.pdf, light.pdf});
  });
}

LightingStrategy::Escaped SceneSuns::escaped(const LightPoint& point, const vec3& wi) const {
  Escaped light = strategy_->escaped(point, wi);
  const SkyDiscs::Light discs = all_.at(wi);
  light.radiance += discs.radiance;
  light.pdf += discs.pdf;
  return light;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/scene_sources.h"

#include "lighting/punctual.h"

namespace chromeball {

SceneSources::SceneSources(const Scene& scene) {
  const auto add = [&](auto source) {
    if (source) all.push_back(std::move(source));
  };
  auto surfaces = Emitters::make(scene);
  emitters = surfaces.get();
  add(std::move(surfaces));
  add(PunctualLights::make(scene));
  const auto addDistant = [&](auto source) {
    distant.push_back(all.size());
    all.push_back(std::move(source));
  };
  if (!scene.suns.empty()) addDistant(std::make_unique<SceneSuns>(scene.suns));
  for (const AmbientLamp& lamp : scene.ambient) addDistant(std::make_unique<AmbientLight>(lamp));
}

namespace {

constexpr uint64_t kSceneSunSet = uint64_t(1) << 32;  // apart from the suns of the strategy `suns`

std::vector<Sun> discsOf(const std::vector<SunLamp>& lamps, bool onlyVisible) {
  std::vector<Sun> suns;
  for (const SunLamp& lamp : lamps)
    if (lamp.isVisible || !onlyVisible) suns.push_back(lamp.sun);
  return suns;
}

}  // namespace

SceneSuns::SceneSuns(const std::vector<SunLamp>& suns)
    : all_(discsOf(suns, false)), visible_(discsOf(suns, true)) {
  for (size_t i = 0; i < suns.size(); ++i) {
    names_.push_back(suns[i].name);
    if (suns[i].isVisible) seen_.push_back(i);
  }
}

void SceneSuns::sample(const LightPoint&, const PixelSampler& sampler,
                       std::vector<DirectionSample>& out) const {
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  all_.sample(u, v, kSceneSunSet, [&](const vec3& wi) {
    const SkyDiscs::Light light = all_.at(wi);
    if (light.pdf > 0) out.push_back({wi, light.radiance / light.pdf, light.pdf});
  });
}

void SceneSuns::splitEscaped(const LightPoint&, const vec3& wi, std::span<Rgb> radiances) const {
  all_.forDiscsAt(wi,
                  [&](size_t i, const SkyDiscs::Light& disc) { radiances[i] += disc.radiance; });
}

void SceneSuns::splitBackground(const vec3&, const vec3& wi, std::span<Rgb> radiances) const {
  visible_.forDiscsAt(
      wi, [&](size_t i, const SkyDiscs::Light& disc) { radiances[seen_[i]] += disc.radiance; });
}

}  // namespace chromeball

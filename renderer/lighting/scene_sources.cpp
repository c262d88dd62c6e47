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
    const Escaped light = all_.at(wi);
    if (light.pdf > 0) out.push_back({wi, light.radiance / light.pdf, light.pdf});
  });
}

void SceneSuns::splitEscaped(const LightPoint&, const vec3& wi, std::span<Rgb> radiances) const {
  all_.forDiscsAt(wi, [&](size_t i, const Escaped& disc) { radiances[i] += disc.radiance; });
}

void SceneSuns::splitBackground(const vec3&, const vec3& wi, std::span<Rgb> radiances) const {
  visible_.forDiscsAt(wi,
                      [&](size_t i, const Escaped& disc) { radiances[seen_[i]] += disc.radiance; });
}

CombinedLight::CombinedLight(std::vector<std::unique_ptr<LightSource>> parts)
    : parts_(std::move(parts)) {
  for (const auto& part : parts_) groupCounts_.push_back(part->groups().size());
}

void CombinedLight::sample(const LightPoint& point, const PixelSampler& sampler,
                           std::vector<DirectionSample>& out) const {
  int firstGroup = 0;
  for (size_t p = 0; p < parts_.size(); firstGroup += int(groupCounts_[p++])) {
    const auto& part = parts_[p];
    const size_t before = out.size();
    part->sample(point, sampler, out);
    for (size_t i = before; i < out.size(); ++i) {
      DirectionSample& s = out[i];
      s.group += firstGroup;
      if (s.isDelta) continue;
      Escaped sum{s.irradiance * s.pdf, s.pdf};
      for (const auto& other : parts_)
        if (other != part) sum += other->escaped(point, s.wi);
      s.irradiance = sum.radiance / sum.pdf;
      s.pdf = sum.pdf;
    }
  }
}

LightSource::Escaped CombinedLight::escaped(const LightPoint& point, const vec3& wi) const {
  Escaped sum{Rgb(0), 0};
  for (const auto& part : parts_) sum += part->escaped(point, wi);
  return sum;
}

// Samples one part; all parts have the same probability.
bool CombinedLight::sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const {
  const uint64_t scaled = uint64_t(numbers.x) * parts_.size();
  const auto& part = parts_[size_t(scaled >> 32)];
  if (!part->sampleDistant({uint32_t(scaled), numbers.y}, out)) return false;
  out.irradiance *= float(parts_.size());
  out.pdf /= float(parts_.size());
  return true;
}

Rgb CombinedLight::background(const vec3& origin, const vec3& wi) const {
  Rgb sum(0);
  for (const auto& part : parts_) sum += part->background(origin, wi);
  return sum;
}

std::vector<std::string> CombinedLight::groups() const {
  std::vector<std::string> names;
  for (const auto& part : parts_)
    for (std::string& name : part->groups()) names.push_back(std::move(name));
  return names;
}

void CombinedLight::splitEscaped(const LightPoint& point, const vec3& wi,
                                 std::span<Rgb> radiances) const {
  for (size_t p = 0; p < parts_.size(); radiances = radiances.subspan(groupCounts_[p++]))
    parts_[p]->splitEscaped(point, wi, radiances.first(groupCounts_[p]));
}

void CombinedLight::splitBackground(const vec3& origin, const vec3& wi,
                                    std::span<Rgb> radiances) const {
  for (size_t p = 0; p < parts_.size(); radiances = radiances.subspan(groupCounts_[p++]))
    parts_[p]->splitBackground(origin, wi, radiances.first(groupCounts_[p]));
}

}  // namespace chromeball

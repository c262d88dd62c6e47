// SPDX-License-Identifier: Apache-2.0
#include "lighting/scene_sources.h"

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

constexpr uint64_t kSceneSunSet = uint64_t(1) << 32;  // apart from the suns of the strategy `suns`

std::vector<Sun> discsOf(const std::vector<SunLamp>& lamps, bool onlyVisible) {
  std::vector<Sun> suns;
  for (const SunLamp& lamp : lamps)
    if (lamp.isVisible || !onlyVisible) suns.push_back(lamp.sun);
  return suns;
}

}  // namespace

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

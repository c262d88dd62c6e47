// SPDX-License-Identifier: Apache-2.0
#include "lighting/combined_light.h"

namespace chromeball {

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
      for (const auto& other : parts_) {
        if (other == part) continue;
        const Escaped light = other->escaped(point, s.wi);
        sum.radiance += light.radiance;
        sum.pdf += light.pdf;
      }
      s.irradiance = sum.radiance / sum.pdf;
      s.pdf = sum.pdf;
    }
  }
}

LightSource::Escaped CombinedLight::escaped(const LightPoint& point, const vec3& wi) const {
  Escaped sum{Rgb(0), 0};
  for (const auto& part : parts_) {
    const Escaped light = part->escaped(point, wi);
    sum.radiance += light.radiance;
    sum.pdf += light.pdf;
  }
  return sum;
}

// Of one part, each with the same probability.
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

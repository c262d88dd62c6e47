// SPDX-License-Identifier: Apache-2.0
#include "lighting/suns.h"

namespace chromeball {
namespace {

constexpr size_t kMaxSampledEach = 2;  // of more discs, one is chosen by power

std::vector<Sun> withAngle(std::vector<Sun> suns, std::optional<double> angle) {
  for (Sun& sun : suns) sun.angle = angle.value_or(sun.angle);
  return suns;
}

}  // namespace

SkyDiscs::SkyDiscs(const std::vector<Sun>& suns, const Rotation& rotation) {
  std::vector<double> powers;
  double power = 0;
  for (const Sun& sun : suns) {
    powers.push_back(luminance(Rgb(sun.irradiance)));
    power += powers.back();
  }
  const bool chooses = power > 0 && powers.size() > kMaxSampledEach;
  if (chooses) choice_.emplace(1, int(powers.size())).setRow(0, powers);
  for (size_t i = 0; i < powers.size(); ++i) {
    const Sun& sun = suns[i];
    const double chord = 2 * std::sin(sun.angle * kPiD / 720);
    const double probability = chooses ? powers[i] / power : 1;
    discs_.push_back({{Frame(vec3(rotation(sun.direction))), float(chord * chord)},
                      {Rgb(sun.radiance()), float(probability / (kPiD * chord * chord))}});
  }
}

Suns::Suns(const Probe& probe, bool compensated, std::optional<double> angle)
    : Suns(extractSuns(probe.latLong()), probe.rotation(), compensated, angle) {}

Suns::Suns(SunExtraction extraction, const Rotation& rotation, bool compensated,
           std::optional<double> angle)
    : remainder_(extraction.remainder, rotation),
      importance_(remainder_, compensated),
      discs_(withAngle(std::move(extraction.suns), angle), rotation) {}

void Suns::sample(const LightPoint& point, const PixelSampler& sampler,
                  std::vector<DirectionSample>& out) const {
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  const auto add = [&](const vec3& wi) {
    const Escaped light = escaped(point, wi);
    if (light.pdf > 0) out.push_back({wi, light.radiance / light.pdf, light.pdf});
  };
  const DirectionSample rest = importance_.sampleDirection(u * 0x1p-32, v * 0x1p-32);
  if (rest.pdf > 0) add(rest.wi);
  discs_.sample(u, v, 0, add);
}

LightSource::Escaped Suns::escaped(const LightPoint& point, const vec3& wi) const {
  Escaped light = importance_.escaped(point, wi);
  light += discs_.at(wi);
  return light;
}

Rgb Suns::background(const vec3&, const vec3& wi) const {
  return remainder_.radiance(wi) + discs_.at(wi).radiance;
}

std::vector<std::string> Suns::groups() const {
  if (discs_.empty()) return {"probe"};
  return {kSunsGroup, "probe"};
}

void Suns::splitEscaped(const LightPoint&, const vec3& wi, std::span<Rgb> radiances) const {
  radiances.front() += discs_.at(wi).radiance;
  radiances.back() += remainder_.radiance(wi);
}

void Suns::splitBackground(const vec3&, const vec3& wi, std::span<Rgb> radiances) const {
  splitEscaped({}, wi, radiances);
}

SplitProbe::SplitProbe(std::unique_ptr<LightSource> strategy, const Probe& probe)
    : SplitProbe(std::move(strategy), extractSuns(probe.latLong()), probe.rotation()) {}

SplitProbe::SplitProbe(std::unique_ptr<LightSource> strategy, const SunExtraction& extraction,
                       const Rotation& rotation)
    : WrappedLight(std::move(strategy)),
      hasSuns_(!extraction.suns.empty()),
      rest_(extraction.remainder, rotation) {}

std::vector<std::string> SplitProbe::groups() const {
  if (!hasSuns_) return {"probe"};
  return {kSunsGroup, "probe"};
}

// The rest is at most the whole: rounding leaves no negative suns.
void SplitProbe::split(const Rgb& whole, const vec3& wi, std::span<Rgb> radiances) const {
  const Rgb rest = hasSuns_ ? glm::min(rest_.radiance(wi), whole) : whole;
  radiances.back() += rest;
  if (hasSuns_) radiances.front() += whole - rest;
}

}  // namespace chromeball

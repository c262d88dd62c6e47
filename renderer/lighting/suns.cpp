// SPDX-License-Identifier: Apache-2.0
#include "lighting/suns.h"

#include "math/trig.h"

namespace chromeball {
namespace {

constexpr size_t kMaxSampledEach = 2;  // with more suns, one is chosen by power

// Rotation about +Y, the same as Probe's.
vec3 rotated(const dvec3& d, double degrees) {
  const double angle = degrees * kPiD / 180, sine = std::sin(angle), cosine = std::cos(angle);
  return vec3(dvec3(d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine));
}

}  // namespace

Suns::Suns(const Probe& probe, bool compensated, std::optional<double> angle)
    : Suns(extractSuns(probe.latLong()), probe.rotationDegrees(), compensated, angle) {}

Suns::Suns(const SunExtraction& extraction, float rotationDegrees, bool compensated,
           std::optional<double> angle)
    : remainder_(extraction.remainder, rotationDegrees), importance_(remainder_, compensated) {
  std::vector<double> powers;
  double power = 0;
  for (const Sun& sun : extraction.suns) {
    powers.push_back(luminance(Rgb(sun.irradiance)));
    power += powers.back();
  }
  const bool chooses = powers.size() > kMaxSampledEach;
  if (chooses) choice_.emplace(1, int(powers.size())).setRow(0, powers);
  for (size_t i = 0; i < powers.size(); ++i) {
    Sun sun = extraction.suns[i];
    if (angle) sun.angle = *angle;
    const double chord = 2 * std::sin(sun.angle * kPiD / 720);
    const double probability = chooses ? powers[i] / power : 1;
    discs_.push_back({Frame(rotated(sun.direction, rotationDegrees)), float(chord * chord),
                      Rgb(sun.radiance()), float(probability / (kPiD * chord * chord))});
  }
}

vec3 Suns::Disc::direction(float u, float v) const {
  const float squared = u * squaredChord;
  float sine, cosine;
  sinCosTurns(v, sine, cosine);
  const float r = std::sqrt(squared * (1 - squared / 4));
  return frame.toWorld({r * cosine, r * sine, 1 - squared / 2});
}

void Suns::sample(const LightPoint& point, const PixelSampler& sampler,
                  std::vector<DirectionSample>& out) const {
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  const auto add = [&](const vec3& wi) {
    const Escaped light = escaped(point, wi);
    if (light.pdf > 0) out.push_back({wi, light.radiance / light.pdf, light.pdf});
  };
  const DirectionSample rest = importance_.sampleDirection(u * 0x1p-32, v * 0x1p-32);
  if (rest.pdf > 0) add(rest.wi);

  // All discs use the same stratified point with different digital shifts, which keep it
  // stratified.
  if (choice_) {
    double position = (u ^ uint32_t(hash(0))) * 0x1p-32;
    const int chosen = choice_->sample(0, position);
    add(discs_[chosen].direction(float(position), toUnit(v ^ uint32_t(hash(1)))));
    return;
  }
  for (size_t i = 0; i < discs_.size(); ++i) {
    const uint64_t shift = hash(i);
    add(discs_[i].direction(toUnit(u ^ uint32_t(shift)), toUnit(v ^ uint32_t(shift >> 32))));
  }
}

LightingStrategy::Escaped Suns::escaped(const LightPoint& point, const vec3& wi) const {
  Escaped light = importance_.escaped(point, wi);
  for (const Disc& disc : discs_)
    if (disc.contains(wi)) {
      light.radiance += disc.radiance;
      light.pdf += disc.pdf;
    }
  return light;
}

Rgb Suns::background(const vec3&, const vec3& wi) const {
  Rgb radiance = remainder_.radiance(wi);
  for (const Disc& disc : discs_)
    if (disc.contains(wi)) radiance += disc.radiance;
  return radiance;
}

}  // namespace chromeball

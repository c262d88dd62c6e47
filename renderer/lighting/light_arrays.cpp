// SPDX-License-Identifier: Apache-2.0
// LightSource: what sources do for rays in arrays unless they override it.
#include "lighting/light_arrays.h"

#include <span>

#include "lighting/light_source.h"

namespace chromeball {

void LightSource::sampleArrays(std::span<const uint32_t> u, const uint32_t* v,
                               LightArrays& out) const {
  std::array<glm::uvec2, kMaxMany> numbers;
  std::array<DirectionSample, kMaxMany> samples;
  for (size_t i = 0; i < u.size(); ++i) numbers[i] = {u[i], v[i]};
  sampleMany(std::span(numbers).first(u.size()), std::span(samples).first(u.size()));
  for (size_t i = 0; i < u.size(); ++i) {
    out.direction.set(i, samples[i].wi);
    out.light.set(i, samples[i].irradiance);
    out.pdf[i] = samples[i].pdf;
  }
}

void LightSource::escapedArrays(const RayArrays& rays, size_t count, LightArrays& out) const {
  const LightPoint anywhere{};
  std::array<Escape, kMaxMany> escapes;
  std::array<Escaped, kMaxMany> found;
  for (size_t i = 0; i < count; ++i) escapes[i] = {&anywhere, rays.direction.at(i)};
  escapedMany(std::span(escapes).first(count), found);
  for (size_t i = 0; i < count; ++i) {
    out.light.set(i, found[i].radiance);
    out.pdf[i] = found[i].pdf;
  }
}

void LightSource::backgroundArrays(const RayArrays& rays, size_t count, LightArrays& out) const {
  std::array<Sight, kMaxMany> sights;
  std::array<Rgb, kMaxMany> found;
  for (size_t i = 0; i < count; ++i) sights[i] = {rays.origin.at(i), rays.direction.at(i)};
  backgroundMany(std::span(sights).first(count), found);
  for (size_t i = 0; i < count; ++i) out.light.set(i, found[i]);
}

}  // namespace chromeball

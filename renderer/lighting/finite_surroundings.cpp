// SPDX-License-Identifier: Apache-2.0
#include "lighting/finite_surroundings.h"

namespace chromeball {

float FiniteSurroundings::solidAngleRatio(const vec3& x, const Surroundings::Point& y) const {
  // cos / distance^2 = dot(n, to) / |to|^3
  const auto solidAngle = [&](const vec3& to) {
    const float squared = glm::dot(to, to);
    return squared > 0 ? glm::dot(y.normal, to) / (squared * std::sqrt(squared)) : 0;
  };
  return solidAngle(x - y.position) / solidAngle(surroundings_.capture - y.position);
}

void FiniteSurroundings::sample(const LightPoint& point, const PixelSampler& sampler,
                                std::vector<DirectionSample>& out) const {
  const size_t before = out.size();
  strategy_->sample(point, sampler, out);
  size_t kept = before;
  for (size_t i = before; i < out.size(); ++i) {
    const Surroundings::Point y = behind(surroundings_.capture, out[i].wi);
    const float ratio = solidAngleRatio(point.position, y);
    // The ratio is 0 if the point lies on the surface itself.
    if (!(ratio > 0) || !isSeen(y, point.position)) continue;
    out[kept++] = {glm::normalize(y.position - point.position), out[i].irradiance * ratio,
                   out[i].pdf / ratio, out[i].isDelta, out[i].group};
  }
  out.resize(kept);
}

LightSource::Escaped FiniteSurroundings::escaped(const LightPoint& point, const vec3& wi) const {
  const Surroundings::Point y = behind(point.position, wi);
  Escaped found = strategy_->escaped(point, glm::normalize(y.position - surroundings_.capture));
  if (found.pdf == 0) return found;
  const float ratio = solidAngleRatio(point.position, y);
  const bool isSampled = ratio > 0 && isSeen(y, surroundings_.capture);
  found.pdf = isSampled ? found.pdf / ratio : 0;
  return found;
}

Rgb FiniteSurroundings::background(const vec3& origin, const vec3& wi) const {
  const Surroundings::Point y = behind(origin, wi);
  const vec3 captured = glm::normalize(y.position - surroundings_.capture);
  return showsLights_ ? strategy_->background(surroundings_.capture, captured)
                      : probe_.radiance(captured);
}

void FiniteSurroundings::splitEscaped(const LightPoint& point, const vec3& wi,
                                      std::span<Rgb> radiances) const {
  const Surroundings::Point y = behind(point.position, wi);
  strategy_->splitEscaped(point, glm::normalize(y.position - surroundings_.capture), radiances);
}

// The probe's radiance, split in the proportions of the strategy's groups.
void FiniteSurroundings::splitBackground(const vec3& origin, const vec3& wi,
                                         std::span<Rgb> radiances) const {
  const Surroundings::Point y = behind(origin, wi);
  const vec3 direction = glm::normalize(y.position - surroundings_.capture);
  const Rgb whole = background(origin, wi), own = strategy_->background(origin, direction);
  Rgb factor;
  for (int k = 0; k < 3; ++k)
    if (own[k] > 0)
      factor[k] = whole[k] / own[k];
    else
      factor[k] = 0, radiances.back()[k] += whole[k];
  std::vector<Rgb> parts(radiances.size(), Rgb(0));
  strategy_->splitBackground(origin, direction, parts);
  for (size_t i = 0; i < parts.size(); ++i) radiances[i] += factor * parts[i];
}

}  // namespace chromeball

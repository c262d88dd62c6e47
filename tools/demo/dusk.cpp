// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"

#include "probe/mapping.h"
#include "texels.h"

namespace chromeball::demo {
namespace {

const vec3 kSun = glm::normalize(vec3(-0.86f, 0.4f, 0.32f));  // to the left, a little behind us
constexpr float kSunRadius = 9;  // degrees: haze makes it wide and soft
const Rgb kSunRadiance(54, 30, 13.5f);

// 0 with our back to the sun, 1 towards it.
float towardsSun(const vec3& d) { return 0.5f + 0.5f * glm::dot(d, kSun); }

Rgb sky(const vec3& d) {
  const float height = std::max(d.y, 0.0f), towards = towardsSun(d);
  const Rgb horizon = glm::mix(Rgb(0.5f, 0.36f, 0.42f), Rgb(1.9f, 0.95f, 0.45f), towards * towards);
  const Rgb zenith = glm::mix(Rgb(0.05f, 0.09f, 0.2f), Rgb(0.14f, 0.2f, 0.36f), towards);
  Rgb color = glm::mix(horizon, zenith, std::pow(height, 0.45f));
  color += Rgb(2.4f, 1.2f, 0.5f) * std::exp(28 * (towards - 1));
  color += Rgb(7, 4, 1.8f) * std::exp(300 * (towards - 1));

  // Clouds on a plane overhead, lit from the sun's side, thin towards the horizon.
  const vec3 p = vec3(d.x, 0, 0.55f * d.z) * (1.6f / (height + 0.16f));
  const float cover = fractalNoise(p + vec3(5, 0, 9), 6);
  const float cloud = glm::smoothstep(0.46f, 0.75f, cover) * glm::smoothstep(0.02f, 0.2f, height);
  const Rgb lit = glm::mix(Rgb(0.42f, 0.32f, 0.4f), Rgb(2.3f, 1.25f, 0.75f), towards * towards);
  return glm::mix(color, lit, 0.8f * cloud);
}

// The sky with two ridges of hills before it, the farther one paler.
Rgb landscape(const vec3& d) {
  constexpr float kBlur = 0.006f;  // about a texel, so that the ridges show no steps
  const float flat = std::max(glm::length(vec2(d.x, d.z)), 1e-6f), elevation = d.y / flat;
  const vec3 bearing = vec3(d.x, 0, d.z) / flat;
  const float towards = towardsSun(d);
  const auto cover = [&](const Rgb& behind, const Rgb& ridge, float top) {
    return glm::mix(ridge, behind, glm::smoothstep(top - kBlur, top + kBlur, elevation));
  };
  const float far = 0.02f + 0.17f * fractalNoise(2.5f * bearing + vec3(20, 0, 4), 5);
  const float near = 0.12f * fractalNoise(4.0f * bearing + vec3(1, 7, 2), 5) - 0.01f;
  const Rgb haze = glm::mix(Rgb(0.2f, 0.17f, 0.26f), Rgb(0.6f, 0.34f, 0.25f), towards * towards);
  const Rgb shade = Rgb(0.07f, 0.062f, 0.09f) * (0.6f + towards);
  return cover(cover(sky(d), haze, far), shade, near);
}

// A lake that ripples a little, dark below us and a mirror in the distance (Schlick's Fresnel).
Rgb lake(const vec3& d) {
  const vec3 p = vec3(d.x, 0, 4 * d.z) * (2.5f / (0.02f - d.y));
  const float ripple = (fractalNoise(p, 3) - 0.5f) * std::min(0.25f * -d.y, 0.04f);
  const float mirror = 0.02f + 0.98f * std::pow(1 + d.y, 5.0f);
  const vec3 reflected = glm::normalize(vec3(d.x, -d.y + ripple, d.z));
  return glm::mix(Rgb(0.035f, 0.04f, 0.055f), landscape(reflected), 0.9f * mirror);
}

Rgb radiance(const vec3& d) {
  if (d.y < 0) return lake(d);
  const float angle = glm::degrees(std::acos(glm::clamp(glm::dot(d, kSun), -1.0f, 1.0f)));
  return landscape(d) + kSunRadiance * glm::smoothstep(kSunRadius, 0.3f * kSunRadius, angle);
}

}  // namespace

Image paintDusk(int width) {
  constexpr int kGrid = 4;  // kGrid^2 directions a texel
  Image image(width, width / 2, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      for (int i = 0; i < kGrid * kGrid; ++i) {
        const dvec2 offset((i % kGrid + 0.5) / kGrid, (i / kGrid + 0.5) / kGrid);
        const dvec2 uv = (dvec2(x, y) + offset) / dvec2(width, image.height);
        sum += radiance(vec3(*uvToDirection(Mapping::LatLong, uv)));
      }
      image.setRgb(x, y, sum / float(kGrid * kGrid));
    }
  roundTexels(image);
  return image;
}

}  // namespace chromeball::demo

// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/light_layers.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "probe/irradiance.h"

namespace chromeball {

Image sumOf(std::span<const Image> layers) {
  assert(!layers.empty());
  return colorImage(layers.front().width, layers.front().height, [&](int x, int y) {
    glm::dvec3 sum(0);
    for (const Image& layer : layers) sum += glm::dvec3(layer.rgb(x, y));
    return Rgb(sum);
  });
}

Image scaled(Image layer, const Rgb& gain) {
  recolor(layer, [&](const Rgb& c) { return gain * c; });
  return layer;
}

Image shadowMatte(const Image& whole, const Image& layer) {
  return colorImage(whole.width, whole.height, [&](int x, int y) {
    const Rgb all = whole.rgb(x, y), part = layer.rgb(x, y);
    Rgb factor(1);
    for (int k = 0; k < 3; ++k)
      if (all[k] > 0) factor[k] = std::clamp(1 - part[k] / all[k], 0.0f, 1.0f);
    return factor;
  });
}

Image relit(const OcclusionLayers& layers, const Image& latLong, const Rotation& rotation) {
  const int width = layers.albedo.width, height = layers.albedo.height;
  std::vector<glm::ivec2> pixels;
  std::vector<vec3> normals;  // in the map, which is not turned
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const vec3 normal = layers.normal.rgb(x, y);
      if (!(glm::dot(normal, normal) > 0)) continue;
      pixels.push_back({x, y});
      normals.push_back(rotation.back(glm::normalize(normal)));
    }
  const std::vector<dvec3> irradiances = exactIrradiance(latLong, normals);
  Image picture(width, height, 3);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const int x = pixels[i].x, y = pixels[i].y;
    const float ao = *layers.ambientOcclusion.at(x, y);
    picture.setRgb(x, y, layers.albedo.rgb(x, y) * (ao * kInvPi) * Rgb(irradiances[i]));
  }
  return picture;
}

}  // namespace chromeball

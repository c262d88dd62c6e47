// SPDX-License-Identifier: Apache-2.0
#include "relight/occlusion_layers.h"

#include <vector>

#include "probe/irradiance.h"

namespace chromeball {

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

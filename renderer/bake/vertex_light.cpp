// SPDX-License-Identifier: Apache-2.0
#include "bake/vertex_light.h"

#include "bake/shown_color.h"
#include "bake/vertex_geometry.h"

namespace chromeball {
namespace {

vec4 colorOf(const PointLight& what, const PlacedMesh& placed, const BakePoint& point,
             const Rgb& light) {
  const Scene& scene = what.scene();
  const Instance& instance = scene.instances[size_t(point.instance)];
  if (showsWhole(what.what(), scene.materials[size_t(instance.material)]))
    return shownColor(what, point, light);
  const float factor = what.what() == BakedLight::Irradiance ? kInvPi : 1;
  const vec4 own = placed.mesh->colors.empty() ? vec4(1) : placed.mesh->colors[point.x];
  return own * vec4(factor * light, 1);
}

}  // namespace

bool showsWhole(BakedLight what, const Material& material) {
  return what == BakedLight::Radiance || (what == BakedLight::Irradiance && material.emits());
}

float brightestOf(const PointLight& what, const std::vector<BakedGeometry>& geometry) {
  float brightest = 0;
  for (const BakedGeometry& part : geometry)
    for (const vec4& color : part.colors)
      if (countsForScale(what.scene(), part.placed->instance))
        brightest = std::max(brightest, maxComponent(Rgb(color)));
  return brightest;
}

std::vector<BakedGeometry> colouredGeometry(const PointLight& what,
                                            const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const BakeResult& baked) {
  std::vector<BakedGeometry> all = vertexGeometry(meshes, points);
  size_t at = 0;
  for (BakedGeometry& geometry : all) {
    const size_t first = at;
    std::vector<uint8_t> isLit;
    for (size_t i = 0; i < geometry.vertices.size(); ++i, ++at) {
      geometry.light.push_back(baked.points[at].mean());
      isLit.push_back(!baked.points[at].buried);
    }
    fillVertices(geometry.triangles, geometry.light, std::move(isLit));
    for (size_t i = 0; i < geometry.light.size(); ++i)
      geometry.colors.push_back(
          colorOf(what, *geometry.placed, points[first + i], geometry.light[i]));
  }
  return all;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "bake/vertex_light.h"

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

std::vector<BakedGeometry> vertexGeometry(const std::vector<PlacedMesh>& meshes,
                                          const std::vector<BakePoint>& points) {
  std::vector<BakedGeometry> all;
  size_t at = 0;
  for (const PlacedMesh& placed : meshes) {
    BakedGeometry& geometry = all.emplace_back(placed);
    std::vector<uint32_t> own(placed.positions.size());
    for (; at < points.size() && points[at].instance == placed.instance; ++at) {
      own[points[at].x] = uint32_t(geometry.vertices.size());
      geometry.vertices.push_back(points[at].x);
    }
    for (uint32_t i = 0; i < placed.triangleCount(); ++i)
      if (const Triangle& t = placed.triangle(i); placed.hasArea(i))
        geometry.add({own[t.x], own[t.y], own[t.z]});
  }
  return all;
}

void fillVertices(const std::vector<Triangle>& triangles, std::vector<Rgb>& light,
                  std::vector<uint8_t> isLit) {
  for (bool grows = true; grows;) {
    grows = false;
    std::vector<Rgb> sums(light.size(), Rgb(0));
    std::vector<int> counts(light.size());
    for (const Triangle& t : triangles)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          if (!isLit[t[a]] && isLit[t[b]]) {
            sums[t[a]] += light[t[b]];
            ++counts[t[a]];
          }
    for (size_t i = 0; i < light.size(); ++i) {
      if (counts[i] == 0) continue;
      light[i] = sums[i] / float(counts[i]);
      isLit[i] = 1;
      grows = true;
    }
  }
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/lamp.h"

#include "math/frame.h"

namespace chromeball {
namespace {

vec3 moved(const vec3& position, const glm::dvec3& origin) {
  return vec3(glm::dvec3(position) - origin);
}

// Counter-clockwise seen from where it shines.
Mesh polygonOf(const DiscLamp& disc, const vec3& centre) {
  const double turn = 2 * kPiD / kDiscSides;
  const double circumradius = disc.radius * std::sqrt(turn / std::sin(turn));  // of equal area
  const Frame frame(disc.direction);
  Mesh mesh;
  mesh.positions.push_back(centre);
  for (uint32_t i = 0; i < kDiscSides; ++i) {
    const double angle = turn * i;
    mesh.positions.push_back(centre +
                             frame.toWorld(vec3(float(circumradius * std::cos(angle)),
                                                float(circumradius * std::sin(angle)), 0)));
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kDiscSides});
  }
  return mesh;
}

Material shining(const DiscLamp& disc, const std::string& name) {
  Material m;
  m.name = name;
  m.baseColor = vec4(0, 0, 0, 1);
  m.metallic = m.specular = 0;
  m.emission = disc.radiance;
  return m;
}

}  // namespace

// Over a spot's cone the falloff is 1 within cosInner, and from there falls to 0 as the square of
// the cosine's share of the way.
float PunctualLight::intensityOfOneWatt() const {
  if (kind == Kind::Point) return 1 / (4 * kPi);
  return 1 / (2 * kPi * ((1 - cosInner) + (cosInner - cosOuter) / 3));
}

void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin) {
  if (lamp.punctual) {
    scene.lights.push_back(*lamp.punctual);
    scene.lights.back().position = moved(lamp.punctual->position, origin);
    return;
  }
  scene.materials.push_back(shining(*lamp.disc, lamp.name));
  scene.meshes.push_back(polygonOf(*lamp.disc, moved(lamp.disc->position, origin)));
  scene.instances.push_back({int(scene.meshes.size()) - 1,
                             int(scene.materials.size()) - 1,
                             int(scene.nodeNames.size()),
                             {}});
  if (!scene.nodeParents.empty()) scene.nodeParents.resize(scene.nodeNames.size() + 1, -1);
  scene.nodeNames.push_back(lamp.name);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/builder/add_lamp.h"

#include <cmath>

#include "math/vec.h"
#include "scene/builder/scene_builder.h"

namespace chromeball {
namespace {

// A polygon whose front side (corners counter-clockwise) emits.
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

Material emitter(const DiscLamp& disc, const std::string& name) {
  Material m;
  m.name = name;
  m.baseColor = vec4(0, 0, 0, 1);
  m.metallic = m.specular = 0;
  m.emission = disc.radiance;
  return m;
}

}  // namespace

void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin) {
  SceneBuilder builder(scene);
  if (lamp.sun) return builder.addSun(*lamp.sun);
  if (lamp.ambient) return builder.addAmbient(*lamp.ambient);
  const vec3 position(lamp.position - origin);
  if (lamp.punctual) {
    PunctualLight light = *lamp.punctual;
    light.position = position;
    return builder.addLight(light);
  }
  const int material = builder.addMaterial(emitter(*lamp.disc, lamp.name));
  builder.addInstance(builder.addMesh(polygonOf(*lamp.disc, position), material), material,
                      builder.addNode(lamp.name));
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/lamp.h"

#include "math/frame.h"

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

// A spot's falloff is 1 within the inner cone and ((cos - cosOuter) / (cosInner - cosOuter))^2
// between the cones.
float PunctualLight::intensityOfOneWatt() const {
  if (kind == Kind::Point) return 1 / (4 * kPi);
  return 1 / (2 * kPi * ((1 - cosInner) + (cosInner - cosOuter) / 3));
}

LampPose PunctualLight::poseAt(float time) const {
  if (!motion) return {position, direction};
  const KeySpan span = keysAround(motion->size(), time);
  const LampPose &from = (*motion)[span.from], &to = (*motion)[span.to];
  return {glm::mix(from.position, to.position, span.fraction),
          glm::normalize(glm::mix(from.direction, to.direction, span.fraction))};
}

void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin) {
  if (lamp.sun) return scene.suns.push_back(*lamp.sun);
  if (lamp.ambient) return scene.ambient.push_back(*lamp.ambient);
  const vec3 position(lamp.position - origin);
  if (lamp.punctual) {
    scene.lights.push_back(*lamp.punctual);
    scene.lights.back().position = position;
    return;
  }
  scene.materials.push_back(emitter(*lamp.disc, lamp.name));
  scene.meshes.push_back(polygonOf(*lamp.disc, position));
  scene.instances.push_back({int(scene.meshes.size()) - 1,
                             int(scene.materials.size()) - 1,
                             int(scene.nodeNames.size()),
                             {}});
  if (!scene.nodeParents.empty()) scene.nodeParents.resize(scene.nodeNames.size() + 1, -1);
  scene.nodeNames.push_back(lamp.name);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "composite/ground.h"

#include "base/error.h"
#include "scene/builder/scene_builder.h"
#include "trace/ray.h"

namespace chromeball {
namespace {

bool looksDown(const Camera& camera, float aspectRatio) {
  constexpr int kGrid = 64;
  const CameraRays rays(camera, aspectRatio);
  for (int i = 0; i <= kGrid; ++i)
    for (int k = 0; k <= kGrid; ++k) {
      Ray ray;
      rays.ray(float(i) / kGrid, float(k) / kGrid, ray.origin, ray.direction);
      if (ray.direction.y < 0) return true;
    }
  return false;
}

}  // namespace

Ground groundAround(const Camera& camera, float aspectRatio, const Bounds& objects, float height,
                    const std::string& location) {
  constexpr float kReach = 30;
  if (!(camera.position.y > height))
    throwInput("{}: the camera is {:.3g} m below the ground; give `ground_height`", location,
               height - camera.position.y);
  if (!looksDown(camera, aspectRatio))
    throwInput("{}: the camera does not see the ground; it looks above the horizon", location);
  const vec3 centre = 0.5f * (objects.min + objects.max);
  const float reach =
      kReach * (float(glm::length(objects.size())) + glm::distance(camera.position, centre));
  const vec2 middle(centre.x, centre.z);
  return {height, middle - reach, middle + reach};
}

void addGround(Scene& scene, const Ground& ground, const Rgb& reflectance) {
  constexpr double kLower = 1e-5;
  const float y = ground.height - float(kLower * glm::length(bounds(scene).size()));
  Mesh mesh;
  mesh.positions = {{ground.min.x, y, ground.max.y},
                    {ground.max.x, y, ground.max.y},
                    {ground.max.x, y, ground.min.y},
                    {ground.min.x, y, ground.min.y}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Material matte;
  matte.name = kGroundNode;
  matte.baseColor = vec4(reflectance, 1);
  matte.metallic = matte.specular = 0;
  matte.doubleSided = true;
  SceneBuilder builder(scene);
  const int material = builder.addMaterial(std::move(matte));
  builder.addInstance(builder.addMesh(std::move(mesh), material), material,
                      builder.addNode(kGroundNode));
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "composite/ground.h"

#include <algorithm>

#include "base/error.h"
#include "trace/ray.h"

namespace chromeball {
namespace {

// The points of the plane that a grid of pixels sees, at most `reach` from the middle along an
// axis. Where neighbouring rays have the horizon between them, the upper one sees it at the reach.
// Empty if no ray points down.
std::vector<vec2> seenPoints(const Camera& camera, float aspectRatio, float height,
                             const vec2& middle, float reach) {
  constexpr int kGrid = 64;
  const CameraRays rays(camera, aspectRatio);
  std::vector<Ray> all;
  float step = 0;  // the largest change of a direction between neighbours
  for (int i = 0; i <= kGrid; ++i)
    for (int k = 0; k <= kGrid; ++k) {
      Ray& ray = all.emplace_back();
      rays.ray(float(i) / kGrid, float(k) / kGrid, ray.origin, ray.direction);
      if (k > 0) step = std::max(step, glm::distance(ray.direction, all[all.size() - 2].direction));
    }
  std::vector<vec2> points;
  if (std::ranges::none_of(all, [](const Ray& ray) { return ray.direction.y < 0; })) return points;
  for (const Ray& ray : all) {
    const vec3& direction = ray.direction;
    if (!(direction.y < step)) continue;
    const float distance = direction.y < 0 ? (height - ray.origin.y) / direction.y : 4 * reach;
    const vec3 point = ray.origin + std::min(distance, 4 * reach) * direction;
    points.push_back(glm::clamp(vec2(point.x, point.z), middle - reach, middle + reach));
  }
  return points;
}

}  // namespace

Ground groundSeenBy(const Camera& camera, float aspectRatio, const Bounds& objects, float height,
                    const std::string& location) {
  constexpr float kSurroundings = 3, kReach = 30;
  if (!(camera.position.y > height))
    throwInput("{}: the camera is {:.3g} m below the ground; give `ground_height`", location,
               height - camera.position.y);
  const vec3 centre = 0.5f * (objects.min + objects.max);
  const float size = float(glm::length(objects.size()));
  const float reach = kReach * (size + glm::distance(camera.position, centre));
  const vec2 middle(centre.x, centre.z);
  const std::vector<vec2> seen = seenPoints(camera, aspectRatio, height, middle, reach);
  if (seen.empty())
    throwInput("{}: the camera does not see the ground; it looks above the horizon", location);
  Ground ground{height, vec2(objects.min.x, objects.min.z) - kSurroundings * size,
                vec2(objects.max.x, objects.max.z) + kSurroundings * size};
  for (const vec2& point : seen) {
    ground.min = glm::min(ground.min, point);
    ground.max = glm::max(ground.max, point);
  }
  return ground;
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
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(std::move(matte));
  scene.nodeNames.emplace_back(kGroundNode);
  if (!scene.nodeParents.empty()) scene.nodeParents.push_back(-1);
  scene.instances.push_back({.mesh = int(scene.meshes.size()) - 1,
                             .material = int(scene.materials.size()) - 1,
                             .node = int(scene.nodeNames.size()) - 1,
                             .toWorld = {}});
}

}  // namespace chromeball

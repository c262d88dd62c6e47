// SPDX-License-Identifier: Apache-2.0
#include "composite/local_scene.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "scene/builder/scene_builder.h"
#include "trace/ray.h"

namespace chromeball {
namespace {

// Applies `change` to copies of the materials of the local scene, and assigns these to its
// instances; objects keep the originals.
template <class Change>
void changeLocalMaterials(Scene& scene, const ObjectMask& isObject, const Change& change) {
  std::map<int, int> copies;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (isObject[i]) continue;
    int& material = scene.instances[i].material;
    const auto [copy, isNew] = copies.try_emplace(material, int(scene.materials.size()));
    if (isNew) {
      scene.materials.push_back(scene.materials[size_t(material)]);
      change(scene.materials.back());
    }
    material = copy->second;
  }
}

// Removes metal and the extensions that only colour or stretch its highlights.
void makeDielectric(Material& m) {
  m.metallic = 0;
  if (m.extended) m.extended->anisotropy = m.extended->iridescence = 0;
}

bool hasLayers(const Material& m) {
  return m.extended && (m.extended->clearcoat > 0 || !isBlack(m.extended->sheenColor) ||
                        m.extended->transmission > 0);
}

}  // namespace

ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location) {
  std::vector<bool> isLocal(scene.nodeNames.size());
  for (const NamedSetting& local : names) {
    bool known = false;
    for (size_t node = 0; node < scene.nodeNames.size(); ++node)
      if (scene.nodeNames[node] == local.name) isLocal[node] = known = true;
    if (!known) {
      const std::vector<std::string_view> all(scene.nodeNames.begin(), scene.nodeNames.end());
      throwInput("{}: the model has no node `{}`; {}", local.location, local.name,
                 didYouMean(local.name, all));
    }
  }
  std::vector<bool> isOutside(isLocal.size());  // of the nodes that have been looked at
  const auto isUnderLocal = [&](int node) {
    std::vector<int> passed;  // looked at for the first time
    for (; node >= 0 && !isLocal[node] && !isOutside[node];
         node = scene.nodeParents.empty() ? -1 : scene.nodeParents[node])
      passed.push_back(node);
    const bool isUnder = node >= 0 && isLocal[node];
    for (const int n : passed) (isUnder ? isLocal : isOutside)[n] = true;
    return isUnder;
  };
  ObjectMask isObject;
  for (const Instance& instance : scene.instances) isObject.push_back(!isUnderLocal(instance.node));
  if (std::find(isObject.begin(), isObject.end(), true) == isObject.end())
    throwInput("{}: every node is part of the local scene; no objects are left to be composited",
               location);
  return isObject;
}

void makeProjected(Scene& scene, const ObjectMask& isObject, const Projection& projection) {
  changeLocalMaterials(scene, isObject, [&](Material& m) {
    m.projection = &projection;
    makeDielectric(m);
    m.specular = 0;
  });
}

void makeGlossy(Scene& scene, const ObjectMask& isObject, float strength, float roughness) {
  changeLocalMaterials(scene, isObject, [&](Material& m) {
    makeDielectric(m);
    m.specular = strength;
    m.specularColor = Rgb(1);
    m.specularGlossiness = false;
    m.ior = 1.5f;
    m.roughness = roughness;
    m.metallicRoughnessTexture = m.specularTexture = m.specularColorTexture = {};
  });
}

bool isLayered(const Scene& scene, const ObjectMask& isObject) {
  for (size_t i = 0; i < scene.instances.size(); ++i)
    if (!isObject[i] && hasLayers(scene.materials[size_t(scene.instances[i].material)]))
      return true;
  return false;
}

std::optional<vec3> flatNormal(const Scene& scene, const ObjectMask& isObject) {
  constexpr double kTolerance = 1e-4;  // relative to the scene's size, and of unit normals
  std::optional<glm::dvec3> normal, point;
  double size = 0, farthest = 0;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (isObject[i]) continue;
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Triangle& t : mesh.triangles) {
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k) p[k] = glm::dvec3(instance.point(mesh.positions[t[k]]));
      glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
      if (!(glm::length(n) > 0)) continue;
      n = glm::normalize(n);
      if (n.y < 0) n = -n;
      if (!normal) normal = n, point = p[0];
      if (glm::length(n - *normal) > kTolerance) return std::nullopt;
      for (const glm::dvec3& corner : p) {
        size = std::max(size, glm::length(corner - *point));
        farthest = std::max(farthest, std::abs(glm::dot(corner - *point, *normal)));
      }
    }
  }
  if (!normal || farthest > kTolerance * size) return std::nullopt;
  return vec3(*normal);
}

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
    throwInput("{}: the camera is {:.3g} m below the ground; give one of them another height",
               location, height - camera.position.y);
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

void setGroundReflectance(Scene& scene, const Rgb& reflectance) {
  for (Material& material : scene.materials)
    if (material.name == kGroundNode) material.baseColor = vec4(reflectance, 1);
}

}  // namespace chromeball

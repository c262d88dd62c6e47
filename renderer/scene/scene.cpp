#include "scene/scene.h"

#include <algorithm>
#include <iterator>

namespace chromeball {
namespace {

template <class T>
size_t bytesOf(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

template <class T>
void moveToEnd(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

size_t Scene::triangleCount() const {
  size_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
  return count;
}

size_t Scene::byteCount() const {
  size_t bytes = bytesOf(instances);
  for (const Mesh& mesh : meshes) {
    bytes += bytesOf(mesh.triangles) + bytesOf(mesh.positions) + bytesOf(mesh.normals) +
             bytesOf(mesh.tangents) + bytesOf(mesh.colors);
    for (const auto& uv : mesh.uvs) bytes += bytesOf(uv);
  }
  for (const auto& grid : grids) bytes += bytesOf(grid->texels8) + bytesOf(grid->texelsFloat);
  return bytes;
}

Bounds bounds(const Scene& scene) {
  Bounds box;
  for (const Instance& instance : scene.instances)
    for (const vec3& position : scene.meshes[instance.mesh].positions) {
      const vec3 p = instance.toWorld.point(position);
      box.min = glm::min(box.min, p);
      box.max = glm::max(box.max, p);
    }
  return box;
}

Camera framingCamera(const Bounds& bounds, float aspectRatio) {
  constexpr float kFov = 47 * kPi / 180;
  constexpr float kMargin = 1.05f;
  const glm::dvec3 from = glm::normalize(glm::dvec3(0.45, 0.35, 1));

  glm::dvec3 centre(0), half(0);
  if (!bounds.empty()) {
    centre = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
    half = 0.5 * (glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
  }
  // Something to look at where there is no extent: a view as wide as the distance from the origin
  // can resolve, or of a metre.
  if (glm::length(half) <= 1e-6 * glm::length(centre)) half += 0.5 + 1e-3 * glm::length(centre);

  Camera camera = Camera::lookAt(vec3(from), vec3(0), vec3(0, 1, 0), kFov);

  // A corner at c (from the centre, in the camera's frame) is in view from the distance d where
  // |c.x| <= (d - c.z) tan(fovX / 2), and the same in y.
  const double tanY = std::tan(0.5 * kFov), tanX = tanY * aspectRatio;
  double distance = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner = half * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const double x = std::fabs(glm::dot(corner, glm::dvec3(camera.right)));
    const double y = std::fabs(glm::dot(corner, glm::dvec3(camera.up)));
    const double z = glm::dot(corner, glm::dvec3(camera.back));
    distance = std::max(distance, z + kMargin * std::max(x / tanX, y / tanY));
  }
  camera.position = vec3(centre + distance * from);
  return camera;
}

void append(Scene& scene, Scene&& other) {
  const int meshes = int(scene.meshes.size()), materials = int(scene.materials.size());
  const int textures = int(scene.textures.size()), nodes = int(scene.nodeNames.size());
  for (Instance& instance : other.instances) {
    instance.mesh += meshes;
    instance.material += materials;
    instance.node += nodes;
  }
  for (Material& material : other.materials)
    for (TextureSlot* slot : textureSlots(material))
      if (*slot) slot->texture += textures;

  moveToEnd(scene.meshes, other.meshes);
  moveToEnd(scene.instances, other.instances);
  moveToEnd(scene.materials, other.materials);
  moveToEnd(scene.textures, other.textures);
  moveToEnd(scene.grids, other.grids);
  moveToEnd(scene.cameras, other.cameras);
  moveToEnd(scene.nodeNames, other.nodeNames);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <iterator>
#include <set>

#include "image/io/texel_file.h"

namespace chromeball {
namespace {

template <class T>
size_t bytesOf(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

size_t bytesOf(const Mesh& mesh) {
  size_t bytes = bytesOf(mesh.triangles) + bytesOf(mesh.positions) + bytesOf(mesh.normals) +
                 bytesOf(mesh.tangents) + bytesOf(mesh.colors);
  for (const auto& uv : mesh.uvs) bytes += bytesOf(uv);
  return bytes;
}

template <class T>
void moveToEnd(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

Scene::Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

size_t Scene::triangleCount() const {
  size_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
  return count;
}

size_t Scene::byteCount() const {
  size_t bytes = bytesOf(instances);
  for (const Mesh& mesh : meshes) bytes += bytesOf(mesh);
  for (const Instance& instance : instances)
    if (instance.motion)
      for (const InstanceMotion::Key& key : instance.motion->keys)
        if (key.mesh != meshes.shared(size_t(instance.mesh))) bytes += bytesOf(*key.mesh);
  return bytes + texelByteCount();
}

size_t Scene::texelByteCount() const {
  size_t bytes = 0;
  std::set<const void*> counted;  // models share data
  for (const auto& grid : grids)
    if (counted.insert(grid.get()).second) bytes += grid->byteCount();
  for (const Texture& texture : textures)
    if (texture.mipLevels && counted.insert(texture.mipLevels.get()).second)
      for (const TexelGrid& level : *texture.mipLevels) bytes += level.byteCount();
  return bytes;
}

size_t Scene::texelFileByteCount() const { return texelFile ? texelFile->byteCount() : 0; }

void Scene::checkTexels() const {
  if (texelFile) texelFile->check();
}

void append(Scene& scene, Scene&& other) {
  const int meshes = int(scene.meshes.size()), materials = int(scene.materials.size());
  const int textures = int(scene.textures.size()), nodes = int(scene.nodeNames.size());
  for (Instance& instance : other.instances) {
    instance.mesh += meshes;
    instance.material += materials;
    instance.node += nodes;
  }
  for (PunctualLight& light : other.lights)
    if (light.node >= 0) light.node += nodes;
  for (Material& material : other.materials)
    for (TextureSlot* slot : textureSlots(material))
      if (*slot) slot->texture += textures;

  scene.meshes.append(std::move(other.meshes));
  moveToEnd(scene.instances, other.instances);
  moveToEnd(scene.materials, other.materials);
  moveToEnd(scene.textures, other.textures);
  moveToEnd(scene.grids, other.grids);
  moveToEnd(scene.cameras, other.cameras);
  moveToEnd(scene.lights, other.lights);
  moveToEnd(scene.suns, other.suns);
  moveToEnd(scene.ambient, other.ambient);
  if (other.texelFile) scene.texelFile = std::move(other.texelFile);
  if (!scene.environment) scene.environment = std::move(other.environment);
  scene.nodeParents.resize(scene.nodeNames.size(), -1);
  other.nodeParents.resize(other.nodeNames.size(), -1);
  for (int& parent : other.nodeParents)
    if (parent >= 0) parent += nodes;
  moveToEnd(scene.nodeParents, other.nodeParents);
  moveToEnd(scene.nodeNames, other.nodeNames);
  moveToEnd(scene.files, other.files);
  moveToEnd(scene.notes, other.notes);
  scene.isAnimated |= other.isAnimated;
  scene.moves |= other.moves;
}

// The scene is one of a builder, where nothing moves while the shutter is open.
void moveOrigin(Scene& scene, const glm::dvec3& origin) {
  if (origin == glm::dvec3(0)) return;
  const auto moved = [&](const vec3& p) { return vec3(glm::dvec3(p) - origin); };
  std::vector<int> users(scene.meshes.size());
  for (const Instance& instance : scene.instances) ++users[size_t(instance.mesh)];
  for (Instance& instance : scene.instances) {
    const bool sharesMesh = users[size_t(instance.mesh)] > 1;
    if (instance.toWorld || sharesMesh) {
      Transform& t = instance.toWorld ? *instance.toWorld : instance.toWorld.emplace();
      t.translation = vec3(glm::dvec3(t.translation) + instance.translationRest - origin);
      instance.translationRest = glm::dvec3(0);
    } else {
      for (vec3& p : scene.meshes.edit(size_t(instance.mesh)).positions) p = moved(p);
    }
  }
  for (Camera& camera : scene.cameras) camera.position = moved(camera.position);
  for (PunctualLight& light : scene.lights) light.position = moved(light.position);
}

}  // namespace chromeball

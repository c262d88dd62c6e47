// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <span>
#include <string>
#include <type_traits>

#include "base/hash.h"

namespace chromeball {
namespace {

// Takes numbers and vectors, arrays of them, and texts.
class SceneHasher {
 public:
  template <class... T>
  void operator()(const T&... values) {
    (one(values), ...);
  }
  uint64_t sum() const { return sum_; }

 private:
  void add(uint64_t value) { sum_ = hash(sum_, value); }
  template <class T>
  void addBytes(const T* items, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(checksum({reinterpret_cast<const char*>(items), count * sizeof(T)}));
  }
  template <class T>
  void one(const std::vector<T>& array) {
    add(array.size());
    addBytes(array.data(), array.size());
  }
  void one(const std::string& text) { add(checksum(text)); }
  template <class T>
  void one(const T& value) {
    addBytes(&value, 1);
  }

  uint64_t sum_ = 0;
};

void hashMesh(const Mesh& mesh, SceneHasher& h) {
  h(mesh.triangles, mesh.positions, mesh.normals, mesh.tangents, mesh.colors);
  for (const auto& uv : mesh.uvs) h(uv);
}

void hashSlot(const TextureSlot& s, SceneHasher& h) {
  h(s.texture, s.uvSet, s.uvRow0, s.uvRow1, s.uvOffset);
}

void hashMaterial(Material m, SceneHasher& h) {
  h(m.baseColor, m.metallic, m.roughness, m.emission, m.ior, m.specular, m.specularColor,
    m.specularGlossiness, m.normalScale, m.alphaMode, m.alphaCutoff, m.doubleSided, m.singleSided,
    m.unlit);
  for (const TextureSlot* slot : textureSlots(m)) hashSlot(*slot, h);
  if (!m.extended) return;
  const ExtendedMaterial& e = *m.extended;
  h(e.transmission, e.thinWalled, e.attenuation, e.dispersion, e.clearcoat, e.clearcoatRoughness,
    e.clearcoatNormalScale, e.sheenColor, e.sheenRoughness, e.anisotropy, e.anisotropyRotation,
    e.iridescence, e.filmIor, e.filmMinThickness, e.filmMaxThickness);
}

void hashCamera(const Camera& c, SceneHasher& h) {
  h(c.name, c.position, c.right, c.up, c.back, c.orthographic, c.fov, c.halfHeight, c.aspect,
    c.lensRadius, c.focus, c.principalPoint, c.distortion.k1, c.distortion.k2);
}

void hashLights(const Scene& scene, SceneHasher& h) {
  for (const PunctualLight& light : scene.lights)
    h(light.kind, light.intensity, light.position, light.direction, light.range, light.innerCone,
      light.outerCone);
  for (const SunLamp& lamp : scene.suns)
    h(lamp.sun.direction, lamp.sun.irradiance, lamp.sun.angle, lamp.isVisible);
  for (const AmbientLamp& lamp : scene.ambient) h(lamp.radiance, lamp.isVisible);
  if (scene.environment) h(scene.environment->texels);
}

}  // namespace

uint64_t hashOf(const Scene& scene) {
  SceneHasher h;
  h(scene.meshes.size(), scene.instances.size(), scene.materials.size());
  for (const Mesh& mesh : scene.meshes) hashMesh(mesh, h);
  for (const Instance& i : scene.instances) {
    const Transform toWorld = i.toWorld.value_or(Transform());
    h(i.mesh, i.material, i.node, toWorld.linear, toWorld.translation, i.translationRest);
  }
  for (const Material& material : scene.materials) hashMaterial(material, h);
  for (const auto& grid : scene.grids)
    h(grid->width, grid->height, grid->texels8, grid->texelsFloat);
  for (const Texture& texture : scene.textures)
    h(texture.wrapS, texture.wrapT, texture.filter, texture.srgb, texture.weightedByAlpha);
  for (const Camera& camera : scene.cameras) hashCamera(camera, h);
  hashLights(scene, h);
  return h.sum();
}

}  // namespace chromeball

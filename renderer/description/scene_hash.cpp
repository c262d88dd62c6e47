// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <span>
#include <string_view>
#include <type_traits>

#include "base/hash.h"

namespace chromeball {
namespace {

// Takes numbers and vectors, and arrays of them.
class SceneHasher {
 public:
  template <class T>
  void operator()(const std::vector<T>& array) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(array.size());
    add(checksum({reinterpret_cast<const char*>(array.data()), array.size() * sizeof(T)}));
  }
  void operator()(std::string_view text) { add(checksum({text.data(), text.size()})); }
  template <class... T>
  void numbers(const T&... values) {
    (one(values), ...);
  }
  uint64_t sum() const { return sum_; }

 private:
  void add(uint64_t value) { sum_ = hash(sum_, value); }
  template <class T>
  void one(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(checksum({reinterpret_cast<const char*>(&value), sizeof value}));
  }

  uint64_t sum_ = 0;
};

void hashMesh(const Mesh& mesh, SceneHasher& h) {
  h(mesh.triangles);
  h(mesh.positions);
  h(mesh.normals);
  h(mesh.tangents);
  h(mesh.colors);
  for (const auto& uv : mesh.uvs) h(uv);
}

void hashSlot(const TextureSlot& s, SceneHasher& h) {
  h.numbers(s.texture, s.uvSet, s.uvRow0, s.uvRow1, s.uvOffset);
}

void hashMaterial(Material m, SceneHasher& h) {
  h.numbers(m.baseColor, m.metallic, m.roughness, m.emission, m.ior, m.specular, m.specularColor,
            m.specularGlossiness, m.normalScale, m.alphaMode, m.alphaCutoff, m.doubleSided,
            m.singleSided, m.unlit);
  for (const TextureSlot* slot : textureSlots(m)) hashSlot(*slot, h);
  if (!m.extended) return;
  const ExtendedMaterial& e = *m.extended;
  h.numbers(e.transmission, e.thinWalled, e.attenuation, e.dispersion, e.clearcoat,
            e.clearcoatRoughness, e.clearcoatNormalScale, e.sheenColor, e.sheenRoughness,
            e.anisotropy, e.anisotropyRotation, e.iridescence, e.filmIor, e.filmMinThickness,
            e.filmMaxThickness);
}

void hashCamera(const Camera& c, SceneHasher& h) {
  h(c.name);
  h.numbers(c.position, c.right, c.up, c.back, c.orthographic, c.fov, c.halfHeight, c.aspect,
            c.lensRadius, c.focus, c.principalPoint, c.distortion.k1, c.distortion.k2);
}

void hashLights(const Scene& scene, SceneHasher& h) {
  for (const PunctualLight& light : scene.lights)
    h.numbers(light.kind, light.intensity, light.position, light.direction, light.range,
              light.innerCone, light.outerCone);
  for (const SunLamp& lamp : scene.suns)
    h.numbers(lamp.sun.direction, lamp.sun.irradiance, lamp.sun.angle, lamp.isVisible);
  for (const AmbientLamp& lamp : scene.ambient) h.numbers(lamp.radiance, lamp.isVisible);
  if (scene.environment) h(scene.environment->texels);
}

}  // namespace

uint64_t hashOf(const Scene& scene) {
  SceneHasher h;
  h.numbers(scene.meshes.size(), scene.instances.size(), scene.materials.size());
  for (const Mesh& mesh : scene.meshes) hashMesh(mesh, h);
  for (const Instance& i : scene.instances) {
    const Transform toWorld = i.toWorld.value_or(Transform());
    h.numbers(i.mesh, i.material, i.node, toWorld.linear, toWorld.translation);
  }
  for (const Material& material : scene.materials) hashMaterial(material, h);
  for (const auto& grid : scene.grids) {
    h.numbers(grid->width, grid->height);
    h(grid->texels8);
    h(grid->texelsFloat);
  }
  for (const Texture& texture : scene.textures)
    h.numbers(texture.wrapS, texture.wrapT, texture.filter, texture.srgb, texture.weightedByAlpha);
  for (const Camera& camera : scene.cameras) hashCamera(camera, h);
  hashLights(scene, h);
  return h.sum();
}

}  // namespace chromeball

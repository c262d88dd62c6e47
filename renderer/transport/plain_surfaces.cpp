// SPDX-License-Identifier: Apache-2.0
#include "transport/plain_surfaces.h"

namespace chromeball {
namespace {

bool isPlain(const Material& m) { return !m.extended && !m.unlit && !m.backLetsLightThrough(); }

bool varies(const Material& m) {
  return m.projection || m.specularGlossiness || m.baseColorTexture || m.metallicRoughnessTexture ||
         m.normalTexture || m.specularTexture || m.specularColorTexture;
}

}  // namespace

PlainSurfaces::PlainSurfaces(const Scene& scene) {
  const Mesh noColors;
  for (const Material& material : scene.materials) {
    Surface surface{};
    surface.mesh = &noColors, surface.material = &material;
    points_.push_back(isPlain(material) && !varies(material) ? materialAt(scene, surface)
                                                             : MaterialPoint());
  }
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[size_t(instance.material)];
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const Kind kind =
        instance.motion || !isPlain(material) ? Kind::Other
        : varies(material) || material.emits() || !mesh.colors.empty() || instance.toWorld
            ? Kind::Varying
            : Kind::Uniform;
    parts_.push_back({kind, material.hidesBack(), material.emits(), instance.material,
                      mesh.triangles.data(), mesh.positions.data(),
                      mesh.normals.empty() ? nullptr : mesh.normals.data()});
    any_ |= kind != Kind::Other;
    anyEmits_ |= kind != Kind::Other && material.emits();
  }
}

}  // namespace chromeball

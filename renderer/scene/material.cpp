// SPDX-License-Identifier: Apache-2.0
#include "scene/material.h"

namespace chromeball {

Material::Material() = default;
Material::Material(const Material&) = default;
Material::Material(Material&&) noexcept = default;
Material& Material::operator=(const Material&) = default;
Material& Material::operator=(Material&&) noexcept = default;
Material::~Material() = default;

std::vector<TextureSlot*> textureSlots(Material& m) {
  std::vector<TextureSlot*> slots = {&m.baseColorTexture, &m.metallicRoughnessTexture,
                                     &m.normalTexture,    &m.emissiveTexture,
                                     &m.specularTexture,  &m.specularColorTexture};
  if (m.extended) {
    ExtendedMaterial& e = *m.extended;
    slots.insert(slots.end(),
                 {&e.transmissionTexture, &e.clearcoatTexture, &e.clearcoatRoughnessTexture,
                  &e.clearcoatNormalTexture, &e.sheenColorTexture, &e.sheenRoughnessTexture,
                  &e.anisotropyTexture, &e.iridescenceTexture, &e.filmThicknessTexture});
  }
  return slots;
}

std::optional<TextureSlot> tangentSpace(const Material& m) {
  if (m.normalTexture) return m.normalTexture;
  if (!m.extended) return std::nullopt;
  if (m.extended->clearcoatNormalTexture) return m.extended->clearcoatNormalTexture;
  if (m.extended->anisotropy > 0) return m.extended->anisotropyTexture;
  return std::nullopt;
}

}  // namespace chromeball

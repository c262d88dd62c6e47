#include "scene/material.h"

namespace chromeball {

std::vector<TextureSlot*> textureSlots(Material& m) {
  std::vector<TextureSlot*> slots = {&m.baseColorTexture, &m.metallicRoughnessTexture,
                                     &m.normalTexture,    &m.emissiveTexture,
                                     &m.specularTexture,  &m.specularColorTexture};
  if (m.extended) {
    ExtendedMaterial& e = *m.extended;
    slots.insert(slots.end(), {&e.transmissionTexture, &e.clearcoatTexture,
                               &e.clearcoatRoughnessTexture, &e.clearcoatNormalTexture});
  }
  return slots;
}

std::optional<TextureSlot> tangentSpace(const Material& m) {
  if (m.normalTexture) return m.normalTexture;
  if (m.extended && m.extended->clearcoatNormalTexture) return m.extended->clearcoatNormalTexture;
  return std::nullopt;
}

}  // namespace chromeball

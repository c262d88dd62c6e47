// SPDX-License-Identifier: Apache-2.0
#include "scene/thin_wall.h"

namespace chromeball {

namespace {

// A smooth boundary that transmits light, without other layers.
bool isClear(const Material& m) {
  if (!m.extended || m.unlit || m.roughness != 0) return false;
  const ExtendedMaterial& e = *m.extended;
  return e.transmission > 0 && e.clearcoat == 0 && isBlack(e.sheenColor) && e.anisotropy == 0 &&
         e.iridescence == 0;
}

}  // namespace

bool passesStraight(const Material& m) { return isClear(m) && m.extended->thinWalled; }

void passShadowsStraight(std::span<Material> materials) {
  for (Material& m : materials)
    m.straightShadows = isClear(m) && !m.extended->thinWalled && m.alphaMode == AlphaMode::Opaque;
}

Rgb sheetTransmittance(const MaterialPoint& m, float transmission, float cosine) {
  const float c = 1 - std::min(cosine, 1.0f), c2 = c * c;
  const float f0 = maxComponent(m.dielectricF0);
  const float reflected = f0 + (m.dielectricF90 - f0) * (c2 * c2 * c);
  return m.baseColor * (transmission * (1 - m.metallic) * (1 - reflected));
}

Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction) {
  if (!passesShadows(*surface.material)) return Rgb(0);
  return sheetTransmittance(materialAt(scene, surface),
                            extendedMaterialAt(scene, instance, surface).transmission,
                            std::fabs(glm::dot(surface.normal, direction)));
}

}  // namespace chromeball

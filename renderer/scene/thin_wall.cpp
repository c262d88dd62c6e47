#include "scene/thin_wall.h"

namespace chromeball {

bool passesStraight(const Material& m) {
  return m.extended && m.extended->transmission > 0 && m.extended->thinWalled && m.roughness == 0 &&
         m.extended->clearcoat == 0 && !m.unlit;
}

Rgb sheetTransmittance(const MaterialPoint& m, float transmission, float cosine) {
  const float c = 1 - std::min(cosine, 1.0f), c2 = c * c;
  const float f0 = maxComponent(m.dielectricF0);
  const float reflected = f0 + (m.dielectricF90 - f0) * (c2 * c2 * c);
  return m.baseColor * (transmission * (1 - m.metallic) * (1 - reflected));
}

Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction) {
  if (!passesStraight(*surface.material)) return Rgb(0);
  return sheetTransmittance(materialAt(scene, surface),
                            extendedMaterialAt(scene, instance, surface).transmission,
                            std::fabs(glm::dot(surface.normal, direction)));
}

}  // namespace chromeball

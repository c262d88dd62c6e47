// SPDX-License-Identifier: Apache-2.0
#include "scene/extended_surface.h"

namespace chromeball {
namespace {

// A boundary that transmits light, without other layers, and is smooth; of a sheet, also where only
// a texture makes it so.
bool isClear(const Material& m) {
  if (m.unlit || !m.transmits()) return false;
  if (!m.isSmooth() && !(m.extended->thinWalled && m.metallicRoughnessTexture)) return false;
  const ExtendedMaterial& e = *m.extended;
  return e.clearcoat == 0 && isBlack(e.sheenColor) && e.anisotropy == 0 && e.iridescence == 0;
}

// A factor, times a channel of a texture if there is one.
float product(const Scene& scene, const Surface& s, float factor, const TextureSlot& slot,
              int channel) {
  return slot && factor != 0 ? factor * lookup(scene, slot, s)[channel] : factor;
}

// The clear coat uses its own normal map or none; the base layer's does not affect it.
vec3 clearcoatNormal(const Scene& scene, const Instance& instance, const Surface& s) {
  const Material& m = *s.material;
  if (!m.normalTexture && !m.extended->clearcoatNormalTexture) return s.normal;
  const std::optional<TangentFrame> frame = tangentFrameAt(s, instance);
  if (!frame) return s.normal;
  vec3 n = frame->normal;
  if (m.extended->clearcoatNormalTexture)
    n = mappedNormal(scene, m.extended->clearcoatNormalTexture, m.extended->clearcoatNormalScale, s,
                     *frame);
  if (!s.frontFace) n = -n;
  return glm::dot(n, s.geometricNormal) > 0 ? n : s.geometricNormal;
}

// Reads the strength and direction of anisotropy (KHR_materials_anisotropy).
void readAnisotropy(const Scene& scene, const Instance& instance, const Surface& s,
                    ExtendedPoint& p) {
  const ExtendedMaterial& e = *s.material->extended;
  const std::optional<TangentFrame> frame = tangentFrameAt(s, instance);
  vec2 direction(1, 0);
  p.anisotropy = e.anisotropy;
  if (e.anisotropyTexture) {
    const vec4 texel = lookup(scene, e.anisotropyTexture, s);
    direction = vec2(texel) * 2.0f - 1.0f;
    p.anisotropy *= texel.z;
  }
  const float c = std::cos(e.anisotropyRotation), sn = std::sin(e.anisotropyRotation);
  direction = {c * direction.x - sn * direction.y, sn * direction.x + c * direction.y};
  const float length = glm::length(direction);
  if (!frame || !(length > 0)) {
    p.anisotropy = 0;
    return;
  }
  p.anisotropyTangent =
      (direction.x / length) * frame->tangent + (direction.y / length) * frame->bitangent;
}

}  // namespace

ExtendedPoint extendedMaterialAt(const Scene& scene, const Instance& instance, const Surface& s) {
  const ExtendedMaterial& e = *s.material->extended;
  ExtendedPoint p;
  p.thinWalled = e.thinWalled;
  p.transmission = product(scene, s, e.transmission, e.transmissionTexture, 0);
  p.clearcoat = product(scene, s, e.clearcoat, e.clearcoatTexture, 0);
  p.clearcoatRoughness = product(scene, s, e.clearcoatRoughness, e.clearcoatRoughnessTexture, 1);
  p.clearcoatNormal = p.clearcoat > 0 ? clearcoatNormal(scene, instance, s) : s.normal;
  if (!isBlack(e.sheenColor)) {
    p.sheenColor = e.sheenColor;
    if (e.sheenColorTexture) p.sheenColor *= Rgb(lookup(scene, e.sheenColorTexture, s));
    p.sheenRoughness = product(scene, s, e.sheenRoughness, e.sheenRoughnessTexture, 3);
  }
  if (e.anisotropy > 0) readAnisotropy(scene, instance, s, p);
  if (e.iridescence > 0) {
    p.iridescence = product(scene, s, e.iridescence, e.iridescenceTexture, 0);
    p.filmIor = e.filmIor;
    p.filmThickness = e.filmThicknessTexture ? glm::mix(e.filmMinThickness, e.filmMaxThickness,
                                                        lookup(scene, e.filmThicknessTexture, s).y)
                                             : e.filmMaxThickness;
  }
  return p;
}

float coatTransmittance(const Scene& scene, const Instance& instance, const Surface& s,
                        const vec3& wo) {
  if (s.material->extended->clearcoat == 0) return 1;
  const ExtendedPoint p = extendedMaterialAt(scene, instance, s);
  if (isInsideBody(s, p)) return 1;
  const float c = 1 - std::min(std::fabs(glm::dot(p.clearcoatNormal, wo)), 1.0f), c2 = c * c;
  return 1 - p.clearcoat * (kCoatF0 + (1 - kCoatF0) * (c2 * c2 * c));
}

bool passesStraight(const Material& m) { return isClear(m) && m.extended->thinWalled; }

void passShadowsStraight(std::span<Material> materials) {
  for (Material& m : materials)
    m.straightShadows = isClear(m) && !m.extended->thinWalled && m.alphaMode == AlphaMode::Opaque;
}

Rgb sheetTransmittance(const MaterialPoint& m, float transmission, float cosine) {
  const float c = 1 - std::clamp(cosine, 0.0f, 1.0f), c2 = c * c;
  const float f0 = maxComponent(m.dielectricF0);
  const float reflected = f0 + (m.dielectricF90 - f0) * (c2 * c2 * c);
  return m.baseColor * (transmission * (1 - m.metallic) * (1 - reflected));
}

Rgb straightTransmittance(const Scene& scene, const Instance& instance, const Surface& surface,
                          const vec3& direction) {
  const Material& material = *surface.material;
  if (!passesShadows(material)) return Rgb(0);
  const MaterialPoint point = materialAt(scene, surface);
  if (!material.isSmooth() && point.roughness * point.roughness >= kSmoothAlpha) return Rgb(0);
  // The same normal as that of the lobe that reflects the rest.
  const vec3 wo = glm::dot(surface.geometricNormal, direction) < 0 ? -direction : direction;
  const vec3 normal = normalThatReflects(surface.normal, surface.geometricNormal, wo);
  return sheetTransmittance(point, extendedMaterialAt(scene, instance, surface).transmission,
                            glm::dot(normal, wo));
}

}  // namespace chromeball

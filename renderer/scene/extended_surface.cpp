#include "scene/extended_surface.h"

namespace chromeball {
namespace {

// A factor, times one channel of a texture where there is one.
float product(const Scene& scene, const Surface& s, float factor, const TextureSlot& slot,
              int channel) {
  return slot && factor != 0 ? factor * lookup(scene, slot, s)[channel] : factor;
}

// The clear coat has its own normal map, or else none: the base's does not reach it.
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

}  // namespace

ExtendedPoint extendedMaterialAt(const Scene& scene, const Instance& instance, const Surface& s) {
  const ExtendedMaterial& e = *s.material->extended;
  ExtendedPoint p;
  p.thinWalled = e.thinWalled;
  p.transmission = product(scene, s, e.transmission, e.transmissionTexture, 0);
  p.clearcoat = product(scene, s, e.clearcoat, e.clearcoatTexture, 0);
  p.clearcoatRoughness = product(scene, s, e.clearcoatRoughness, e.clearcoatRoughnessTexture, 1);
  p.clearcoatNormal = p.clearcoat > 0 ? clearcoatNormal(scene, instance, s) : s.normal;
  return p;
}

}  // namespace chromeball

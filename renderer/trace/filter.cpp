// SPDX-License-Identifier: Apache-2.0
#include "trace/filter.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "scene/extended_surface.h"
#include "scene/surface.h"
#include "trace/ray.h"

namespace chromeball {
namespace {

const Scene& sceneOf(const RTCFilterFunctionNArguments* arguments) {
  return *static_cast<const Scene*>(arguments->geometryUserPtr);
}

Hit hitOf(const RTCFilterFunctionNArguments* arguments) {
  RTCHitN* hit = arguments->hit;
  return {instanceOf(sceneOf(arguments), RTCHitN_instID(hit, 1, 0, 0), RTCHitN_geomID(hit, 1, 0)),
          RTCHitN_primID(hit, 1, 0),
          {RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0)},
          RTCRayN_tfar(arguments->ray, 1, 0)};
}

// Adds the optical depth of the body from its boundary to the end of the ray, or to the origin if
// the ray is infinite; subtracts it where the ray leaves the body.
void absorb(Query& query, const Material& body, bool enters, float distance) {
  const Rgb change = (enters ? 1.0f : -1.0f) * body.extended->attenuation;
  query.opticalDepth +=
      (std::isfinite(query.length) ? query.length - distance : -distance) * change;
  query.attenuation += change;
  query.largestAttenuation = glm::max(query.largestAttenuation, body.extended->attenuation);
}

bool isPartlyCoveredBody(const Material& m) {
  return m.alphaMode != AlphaMode::Opaque && m.isBody();
}

}  // namespace

bool isCovered(const Scene& scene, const Hit& hit, const vec3& direction, float time,
               uint32_t key) {
  const Instance& instance = scene.instances[hit.instance];
  const float alpha = surfaceAlpha(scene, instance, hit.triangle, hit.barycentric);
  const uint64_t surface = uint64_t(hit.instance) << 32 | hit.triangle;
  if (!(alpha < 1 && toUnit(uint32_t(hash(key, surface))) >= alpha)) return true;
  return isPartlyCoveredBody(scene.materials[size_t(instance.material)]) &&
         isFromBehind(scene, instance, hit.triangle, direction, time);
}

void filterClosest(const RTCFilterFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const Query*>(arguments->context);
  const float time = RTCRayN_time(arguments->ray, 1, 0);
  if (!isCovered(sceneOf(arguments), hitOf(arguments), query.direction, time, query.key))
    arguments->valid[0] = 0;
}

void filterShadow(const RTCFilterFunctionNArguments* arguments) {
  auto& query = *reinterpret_cast<Query*>(arguments->context);
  const Scene& scene = sceneOf(arguments);
  const Hit hit = hitOf(arguments);
  const Instance& instance = scene.instances[hit.instance];
  const float time = RTCRayN_time(arguments->ray, 1, 0);
  if (scene.materials[instance.material].backLetsLightThrough() &&
      !isFromBehind(scene, instance, hit.triangle, query.direction, time)) {
    arguments->valid[0] = 0;
    return;
  }
  const Material& material = scene.materials[instance.material];
  float alpha = surfaceAlpha(scene, instance, hit.triangle, hit.barycentric);
  if (isPartlyCoveredBody(material) &&
      isFromBehind(scene, instance, hit.triangle, query.direction, time))
    alpha = std::ranges::count(query.inside, &material) > 0 ? 1.0f : 0.0f;
  Rgb passed(1 - alpha);
  if (alpha > 0 && passesShadows(material)) {
    const Surface surface =
        surfaceAt(scene, instance, hit.triangle, hit.barycentric, -query.direction, 0, time);
    passed += alpha * straightTransmittance(scene, instance, surface, query.direction);
    if (material.straightShadows) absorb(query, material, surface.frontFace, hit.distance);
  }
  query.transmittance *= passed;
  if (!isBlack(query.transmittance)) arguments->valid[0] = 0;
}

}  // namespace chromeball

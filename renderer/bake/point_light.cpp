// SPDX-License-Identifier: Apache-2.0
#include "bake/point_light.h"

#include "approximate/occlusion.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr int kProbingRays = 16;

bool hidesItsInside(const Material& material) {
  return material.alphaMode == AlphaMode::Opaque &&
         !(material.extended && material.extended->transmission > 0);
}

// A ray that ends at the surface, as if a camera above it looked down along the normal.
Ray rayTo(const Surface& surface) { return {surface.position + surface.normal, -surface.normal}; }

}  // namespace

Surface PointLight::surfaceAt(const BakePoint& point) const {
  const Instance& instance = scene().instances[size_t(point.instance)];
  Surface surface =
      chromeball::surfaceAt(scene(), instance, point.triangle, point.barycentric, vec3(0, 0, 1));
  if (!surface.frontFace)
    surface = chromeball::surfaceAt(scene(), instance, point.triangle, point.barycentric,
                                    -surface.geometricNormal);
  if (what_ == BakedLight::Radiance || !surface.material->normalTexture) return surface;
  if (const auto frame = tangentFrameAt(surface, instance);
      frame && glm::dot(frame->normal, surface.geometricNormal) > 0)
    surface.normal = frame->normal;
  return surface;
}

Rgb PointLight::irradiance(const Surface& surface, PathContext& context) const {
  PathState state;
  state.ray = rayTo(surface);
  const MaterialPoint white{Rgb(1), 0, 1, Rgb(0), 0};
  const Bsdf bsdf(white, surface, surface.normal, tracer_.world().bsdfTables);
  return kPi * tracer_.reflected(state, surface, bsdf, context);
}

Rgb PointLight::sample(const BakePoint& point, const Surface& surface, PathContext& context) const {
  ++context.counts.camera;
  context.sampler.startVertex(0);
  switch (what_) {
    case BakedLight::Irradiance:
      return irradiance(surface, context);
    case BakedLight::AmbientOcclusion:
      return cosineSkyRay(tracer_.world(), surface, surface.normal, distance_,
                          tracer_.settings().visible, context)
          .transmittance;
    case BakedLight::Radiance:
      break;
  }
  PathState state;
  state.ray = rayTo(surface);
  const Hit hit{uint32_t(point.instance), point.triangle, point.barycentric, 1};
  return tracer_.follow(state, hit, context);
}

bool PointLight::isBuried(const BakePoint& point, const Surface& surface,
                          const std::vector<PlacedMesh>& meshes, PathContext& context) const {
  const World& world = tracer_.world();
  int behind = 0;
  for (int i = 0; i < kProbingRays; ++i) {
    context.sampler.startSample(uint32_t(i));
    context.sampler.startVertex(0);
    const vec3 local = squareToUniformHemisphere(context.sampler.get2(dimension::kLight));
    const vec3 direction = Frame(surface.geometricNormal).toWorld(local);
    Hit hit;
    ++context.counts.shadow;
    if (!world.accel.intersect({surface.rayOrigin(direction), direction},
                               context.sampler.sampleKey(), hit))
      continue;
    const Instance& instance = world.scene.instances[hit.instance];
    if (!hidesItsInside(world.scene.materials[size_t(instance.material)])) continue;
    if (!meshes[hit.instance].isClosed[hit.triangle] && hit.distance > point.extent) continue;
    behind += isFromBehind(world.scene, instance, hit.triangle, direction);
  }
  return 2 * behind > kProbingRays;
}

}  // namespace chromeball

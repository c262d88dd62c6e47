// SPDX-License-Identifier: Apache-2.0
#include "integrate/environment_map.h"

#include "integrate/first_surface.h"
#include "math/frame.h"
#include "shading/ggx.h"
#include "trace/surface_ray.h"

namespace chromeball {
namespace {

// Light samples alone find the light of sources.
PathSettings withoutMis(PathSettings settings) {
  settings.mis = Mis::Off;
  settings.estimateDepthCut = false;
  return settings;
}

// A direction in which microfacets reflect what is seen along wo; their normals are around the
// bisector of wo and the middle of the lobe.
vec3 reflectedBy(const MapLobe& lobe, const vec3& wo, vec2 u) {
  const float alpha = lobe.roughness * lobe.roughness;
  if (alpha < ggx::kSmoothAlpha) return lobe.direction;
  const Frame frame(glm::normalize(wo + lobe.direction));
  const vec3 local = frame.toLocal(wo);
  const vec3 h = ggx::sampleVisibleNormal(local, alpha, u);
  return frame.toWorld(2 * glm::dot(local, h) * h - local);
}

}  // namespace

struct EnvironmentMapIntegrator::Point {
  const FirstSurface& first;
  const PathState& state;
  const Bsdf& bsdf;
  Vertex vertex;
};

EnvironmentMapIntegrator::EnvironmentMapIntegrator(const World& world, const LightSource& lighting,
                                                   const EnvironmentLight& environment,
                                                   const RenderSettings& settings)
    : environment_(environment),
      occlusion_(settings.occlusion),
      tracer_(world, lighting, withoutMis(settings.path())),
      direct_(world, lighting, tracer_.settings()) {
  if (settings.integrator == IntegratorKind::AmbientOcclusion)
    occlusion_.ambient = occlusion_.reflection = true;
  if (const LightSource* suns = environment.suns())
    directSuns_.emplace(world, *suns, tracer_.settings());
}

Sample EnvironmentMapIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  ++context.counts.camera;
  PathState state = camera.path();
  Rgb radiance(0);
  const auto first = firstReflector(tracer_, state, camera.hit, context, radiance);
  if (!first) return context.clamp(radiance);
  const Bsdf bsdf = first->bsdf(tracer_, state);
  const GuidedBsdf guided(bsdf, first->surface.position, -state.ray.direction, nullptr);
  const LightPoint light{first->surface.position, bsdf.normal(),      &bsdf, 0,
                         bsdf.transmits(),        first->surface.time};
  const Point point{
      *first, state, bsdf, {light, first->surface, guided, state.media, nullptr, state.throughput}};
  radiance += ofSources(point, context) + ofProbe(point, context);
  return context.clamp(radiance);
}

Rgb EnvironmentMapIntegrator::ofSources(const Point& point, PathContext& context) const {
  Rgb sum(0);
  for (size_t i = 0; i < tracer_.world().sources.all.size(); ++i)
    sum += direct_.ofScene(i, point.vertex, context);
  if (directSuns_) sum += directSuns_->probe(point.vertex, context);
  return sum;
}

// Of the sources that light samples do not find: for a smooth lobe, all that is seen; else the
// light that no light sample has a pdf for, which is the same from all directions
// (ambient_light.h).
Rgb EnvironmentMapIntegrator::unsampled(const Point& point, const MapLobe& lobe) const {
  const bool isSmooth = !lobe.isDiffuse && lobe.roughness == 0;
  Rgb sum(0);
  const auto add = [&](const LightSource& source) {
    if (isSmooth) {
      sum += source.background(point.first.surface.position, lobe.direction);
    } else if (const auto found = source.escaped(point.vertex.point, lobe.direction);
               found.pdf == 0) {
      sum += found.radiance;
    }
  };
  const SceneSources& sources = tracer_.world().sources;
  for (const size_t i : sources.distant) add(*sources.all[i]);
  if (environment_.suns()) add(*environment_.suns());
  return sum;
}

Rgb EnvironmentMapIntegrator::diffuse(const Point& point, const MapLobe& lobe,
                                      PathContext& context) const {
  const Rgb radiance =
      environment_.maps().irradiance(lobe.direction) * kInvPi + unsampled(point, lobe);
  if (!occlusion_.ambient) return radiance;
  return radiance * cosineSkyRay(tracer_.world(), point.first.surface, lobe.direction,
                                 occlusion_.distance, tracer_.settings().visible, context)
                        .transmittance;
}

Rgb EnvironmentMapIntegrator::specular(const Point& point, const MapLobe& lobe,
                                       PathContext& context) const {
  const Surface& surface = point.first.surface;
  const PrefilteredProbe& maps = environment_.maps();
  const bool isTransmitted = glm::dot(surface.geometricNormal, lobe.direction) <= 0;
  const bool isSampled =
      !isTransmitted && lobe.roughness > 0 && lobe.roughness < PrefilteredProbe::kLeastRoughness;
  const bool isBlocked = !isTransmitted && occlusion_.reflection;
  vec3 wi = lobe.direction;
  if (isSampled || isBlocked)
    wi = reflectedBy(lobe, -point.state.ray.direction, context.sampler.get2(dimension::kBsdf));
  const Rgb radiance =
      (isSampled ? maps.radiance(wi, 0) : maps.radiance(lobe.direction, lobe.roughness)) +
      unsampled(point, lobe);
  if (!isBlocked) return radiance;
  if (glm::dot(surface.geometricNormal, wi) <= 0) return Rgb(0);
  ++context.counts.shadow;
  return radiance *
         tracer_.world().accel.transmittance(rayFrom(surface, wi), tracer_.settings().visible);
}

Rgb EnvironmentMapIntegrator::ofProbe(const Point& point, PathContext& context) const {
  Rgb sum(0);
  for (const MapLobe& lobe : point.bsdf.mapLobes())
    sum += lobe.albedo *
           (lobe.isDiffuse ? diffuse(point, lobe, context) : specular(point, lobe, context));
  return sum;
}

}  // namespace chromeball

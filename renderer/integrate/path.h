// Radiance along one path: path tracing with next-event estimation and multiple importance
// sampling.
#pragma once

#include <optional>
#include <vector>

#include "film/aov.h"
#include "lighting/emitters.h"
#include "lighting/strategy.h"
#include "scene/surface.h"
#include "shading/bsdf.h"
#include "trace/ray.h"

namespace chromeball {

struct RayCounts {
  uint64_t camera = 0, shadow = 0, bounce = 0;

  void add(const RayCounts& other) {
    camera += other.camera, shadow += other.shadow, bounce += other.bounce;
  }
};

// Everything a path needs, the same for all paths of a render. `Rays` answers intersect() and
// transmittance() as Accel does; a benchmark passes one that also records.
template <class Rays>
struct PathScene {
  const Scene& scene;
  const Rays& rays;
  const LightingStrategy& lighting;
  const Emitters* emitters;  // null where nothing emits
  Mis mis;
  int maxDepth;            // 0: emission seen by the camera; 1: direct light; ...
  bool hideProbe = false;  // from the camera
  float mirrorAlpha = lighting.mirrorAlpha();
};

// Weight of a sample found with density `own` (> 0; infinite for a delta light) that the other
// technique finds with `other`.
inline float misWeight(Mis mis, float own, float other) {
  const float ratio = other / own;
  return 1 / (1 + (mis == Mis::Power ? ratio * ratio : ratio));
}

// Weight of what the BSDF's sample found. Density `pdf` 0 stands for a mirror (or the camera), with
// which no light sample competes; with MIS off, light samples take all they can find.
inline float bsdfSampleWeight(Mis mis, float pdf, float lightDensity) {
  if (pdf == 0 || lightDensity == 0) return 1;
  return mis == Mis::Off ? 0 : misWeight(mis, pdf, lightDensity);
}

inline float lightSampleWeight(Mis mis, float density, float bsdfPdf) {
  return mis == Mis::Off ? 1 : misWeight(mis, density, bsdfPdf);
}

// Light from the probe by the strategy's samples.
template <class Rays>
Rgb probeLight(const PathScene<Rays>& path, const LightPoint& point, const Surface& surface,
               const PixelSampler& sampler, std::vector<DirectionSample>& samples,
               RayCounts& counts) {
  samples.clear();
  path.lighting.sample(point, sampler, samples);
  Rgb light(0);
  for (const DirectionSample& s : samples) {
    const Bsdf::Value bsdf = point.bsdf->evaluate(s.wi);
    if (isBlack(bsdf.fCos)) continue;
    ++counts.shadow;
    const float passed = path.rays.transmittance({surface.rayOrigin(s.wi), s.wi});
    if (passed == 0) continue;
    light += bsdf.fCos * s.irradiance * (passed * lightSampleWeight(path.mis, s.density, bsdf.pdf));
  }
  return light;
}

// Light from one point on an emissive triangle.
template <class Rays>
Rgb emitterLight(const PathScene<Rays>& path, const LightPoint& point, const Surface& surface,
                 const PixelSampler& sampler, RayCounts& counts) {
  const Emitters::Point emitter = path.emitters->sample(sampler.get2(dimension::kEmitter));
  const vec3 to = emitter.position - surface.position;
  const float distance = glm::length(to);
  if (!(distance > surface.rayOffset)) return Rgb(0);
  const vec3 wi = to / distance;
  const Bsdf::Value bsdf = point.bsdf->evaluate(wi);
  if (isBlack(bsdf.fCos)) return Rgb(0);

  const Instance& instance = path.scene.instances[emitter.instance];
  const Surface source =
      surfaceAt(path.scene, instance, emitter.triangle, emitter.barycentric, -wi);
  const Rgb radiance = emittedRadiance(path.scene, source);
  const float cosine = glm::dot(source.geometricNormal, -wi);
  if (isBlack(radiance) || !(cosine > 0)) return Rgb(0);

  // From one offset point to the other, so that neither surface shadows itself.
  const vec3 origin = surface.rayOrigin(wi), target = source.rayOrigin(-wi);
  const float length = glm::length(target - origin);
  ++counts.shadow;
  const float passed = path.rays.transmittance({origin, (target - origin) / length, length});
  const float density = path.emitters->density(instance.material, distance, cosine);
  return bsdf.fCos * radiance * (passed * lightSampleWeight(path.mis, density, bsdf.pdf) / density);
}

// Ends a path at random in proportion to what it can still carry; unbiased, since the survivors are
// raised by as much. The first two bounces always go on: they carry most of the picture.
inline bool survivesRoulette(Rgb& throughput, int depth, const PixelSampler& sampler) {
  if (depth < 2) return true;
  const float survival = std::min(maxComponent(throughput), 0.95f);
  if (!(sampler.get1(dimension::kRoulette) < survival)) return false;
  throughput /= survival;
  return true;
}

template <class Rays>
std::optional<Hit> closestHit(const Rays& rays, const Ray& ray, const PixelSampler& sampler) {
  Hit hit;
  if (!rays.intersect(ray, sampler.sampleKey(), hit)) return std::nullopt;
  return hit;
}

// Radiance towards the camera along `ray`, which meets `hit` first. `samples` is scratch memory;
// `first` may be null.
template <class Rays>
Rgb pathRadiance(const PathScene<Rays>& path, Ray ray, std::optional<Hit> hit,
                 PixelSampler& sampler, std::vector<DirectionSample>& samples, RayCounts& counts,
                 FirstHit* first) {
  Rgb radiance(0), throughput(1);
  LightPoint from{};
  float pdf = 0;  // of the ray's direction at `from`; 0 for the camera and mirrors
  ++counts.camera;

  for (int depth = 0;; ++depth) {
    sampler.startVertex(depth);
    if (depth > 0) hit = closestHit(path.rays, ray, sampler);
    if (!hit) {
      if (depth == 0 && path.hideProbe) return radiance;
      if (pdf == 0) return radiance + throughput * path.lighting.background(ray.direction);
      const auto escaped = path.lighting.escaped(from, ray.direction);
      return radiance +
             throughput * escaped.radiance * bsdfSampleWeight(path.mis, pdf, escaped.density);
    }

    const Instance& instance = path.scene.instances[hit->instance];
    const vec3 wo = -ray.direction;
    const Surface surface = surfaceAt(path.scene, instance, hit->triangle, hit->barycentric, wo);
    if (surface.material->emits()) {
      float density = 0;
      if (path.emitters && !surface.material->unlit)
        density =
            path.emitters->density(instance.material, glm::length(surface.position - from.position),
                                   std::max(glm::dot(surface.geometricNormal, wo), 1e-12f));
      radiance += throughput * emittedRadiance(path.scene, surface) *
                  bsdfSampleWeight(path.mis, pdf, density);
    }
    const bool ends = depth == path.maxDepth || surface.material->unlit;
    if (ends && !(first && depth == 0)) return radiance;

    const MaterialPoint material = materialAt(path.scene, surface);
    if (first && depth == 0)
      *first = {true,
                glm::length(surface.position - ray.origin),
                material.baseColor,
                surface.normal,
                instance.material,
                instance.node};
    if (ends) return radiance;

    const Bsdf bsdf(material, surface, wo, path.mirrorAlpha);
    from = {surface.position, bsdf.normal(), wo, &bsdf, depth};
    if (bsdf.hasContinuousLobe()) {
      radiance += throughput * probeLight(path, from, surface, sampler, samples, counts);
      if (path.emitters)
        radiance += throughput * emitterLight(path, from, surface, sampler, counts);
    }

    BsdfSample next;
    if (!bsdf.sample(sampler.get2(dimension::kBsdf), sampler.get1(dimension::kLobe), next))
      return radiance;
    throughput *= next.weight;
    if (!survivesRoulette(throughput, depth, sampler)) return radiance;
    pdf = next.pdf;
    ray = {surface.rayOrigin(next.wi), next.wi};
    from.bsdf = nullptr;  // it ends with this turn of the loop
    ++counts.bounce;
  }
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The light that comes to one vertex of a path straight from its sources, and how it is weighted
// against what the BSDF's own samples find.
#pragma once

#include <vector>

#include "integrate/depth_cut.h"
#include "integrate/media.h"
#include "lighting/emitters.h"
#include "lighting/punctual.h"
#include "lighting/strategy.h"
#include "scene/camera.h"
#include "scene/surface.h"
#include "shading/bsdf.h"
#include "trace/ray.h"

namespace chromeball {

struct RayCounts {
  uint64_t camera = 0, shadow = 0, bounce = 0;
  DepthCut depthCut;

  void add(const RayCounts& other) {
    camera += other.camera, shadow += other.shadow, bounce += other.bounce;
    depthCut.add(other.depthCut);
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
  int maxDepth;                              // 0: emission seen by the camera; 1: direct light; ...
  bool hideProbe = false;                    // from the camera
  const PunctualLights* punctual = nullptr;  // null where there are none
  float mirrorAlpha = lighting.mirrorAlpha();
  int maxTransmissionDepth = kUsualTransmissionDepth;  // bounces in bodies; not part of maxDepth
  bool measuresCut = true;                             // what the limits of depth take (DepthCut)
};

// Weight of a sample found with pdf `own` (> 0; infinite for a delta light) that the other
// technique finds with `other`.
inline float misWeight(Mis mis, float own, float other) {
  const float ratio = other / own;
  return 1 / (1 + (mis == Mis::Power ? ratio * ratio : ratio));
}

// Weight of what the BSDF's sample found. Pdf `pdf` 0 stands for a mirror (or the camera), with
// which no light sample competes; with MIS off, light samples take all they can find.
inline float bsdfSampleWeight(Mis mis, float pdf, float lightPdf) {
  if (pdf == 0 || lightPdf == 0) return 1;
  return mis == Mis::Off ? 0 : misWeight(mis, pdf, lightPdf);
}

inline float lightSampleWeight(Mis mis, float pdf, float bsdfPdf) {
  return mis == Mis::Off ? 1 : misWeight(mis, pdf, bsdfPdf);
}

// What lamps light beside the broad lobes.
inline Bsdf::Value narrowLobes(const Bsdf& bsdf, const vec3& wi) {
  if (!bsdf.has(Lobes::Narrow)) return {Rgb(0), 0};
  return bsdf.evaluate(wi, Lobes::Narrow);
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
    const Rgb passed = path.rays.transmittance({surface.rayOrigin(s.wi), s.wi});
    if (isBlack(passed)) continue;
    light += bsdf.fCos * s.irradiance * passed * lightSampleWeight(path.mis, s.pdf, bsdf.pdf);
  }
  return light;
}

// As transmittance(), for a ray that ends just before a point of the instance, a lamp. Rays that do
// not see all of the scene have an overload of this.
template <class Rays>
Rgb transmittanceTo(const Rays& rays, uint32_t /*instance*/, const Ray& ray) {
  return rays.transmittance(ray);
}

// Light from one point on an emissive triangle.
template <class Rays>
Rgb emitterLight(const PathScene<Rays>& path, const LightPoint& point, const Surface& surface,
                 const Media& media, const PixelSampler& sampler, RayCounts& counts) {
  const Emitters::Point emitter = path.emitters->sample(sampler.getFine1(dimension::kEmitter),
                                                        sampler.get1(dimension::kEmitter + 1));
  const vec3 to = emitter.position - surface.position;
  const float distance = glm::length(to);
  if (!(distance > surface.rayOffset)) return Rgb(0);
  const vec3 wi = to / distance;
  const Bsdf::Value broad = point.bsdf->evaluate(wi);
  const Bsdf::Value narrow = narrowLobes(*point.bsdf, wi);
  if (isBlack(broad.fCos) && isBlack(narrow.fCos)) return Rgb(0);

  const Instance& instance = path.scene.instances[emitter.instance];
  const Surface source =
      surfaceAt(path.scene, instance, emitter.triangle, emitter.barycentric, -wi);
  // A ray that the BSDF chose meets the lamp with probability alpha.
  const Rgb radiance = emittedRadiance(path.scene, instance, source, -wi) *
                       surfaceAlpha(path.scene, instance, emitter.triangle, emitter.barycentric);
  const float cosine = glm::dot(source.geometricNormal, -wi);
  if (isBlack(radiance) || !(cosine > 0)) return Rgb(0);

  // From one offset point to the other, so that neither surface shadows itself.
  const vec3 origin = surface.rayOrigin(wi), target = source.rayOrigin(-wi);
  const float length = glm::length(target - origin);
  ++counts.shadow;
  Rgb passed =
      transmittanceTo(path.rays, emitter.instance, {origin, (target - origin) / length, length});
  if (media.inside() || surface.material->extended)
    passed *= Media(media).follow(surface, wi).transmittance(length);
  const float pdf = path.emitters->pdf(instance.material, distance, cosine);
  const Rgb fCos = broad.fCos * lightSampleWeight(path.mis, pdf, broad.pdf) +
                   narrow.fCos * lightSampleWeight(path.mis, pdf, narrow.pdf);
  return fCos * radiance * passed / pdf;
}

// Light from the lamps without extent.
template <class Rays>
Rgb punctualLight(const PathScene<Rays>& path, const LightPoint& point, const Surface& surface,
                  const Media& media, const PixelSampler& sampler, RayCounts& counts) {
  Rgb light(0);
  path.punctual->sample(point, sampler, [&](const PunctualSample& s) {
    const Rgb fCos = point.bsdf->evaluate(s.wi).fCos + narrowLobes(*point.bsdf, s.wi).fCos;
    if (isBlack(fCos)) return;
    ++counts.shadow;
    Rgb passed = path.rays.transmittance({surface.rayOrigin(s.wi), s.wi, s.distance});
    if (media.inside() || surface.material->extended)
      passed *= Media(media).follow(surface, s.wi).transmittance(s.distance);
    light += fCos * s.irradiance * passed;
  });
  return light;
}

}  // namespace chromeball

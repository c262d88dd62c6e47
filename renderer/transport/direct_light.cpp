// SPDX-License-Identifier: Apache-2.0
#include "transport/direct_light.h"

#include "scene/extended_surface.h"
#include "trace/accel.h"
#include "transport/light_groups.h"
#include "transport/path_settings.h"

namespace chromeball {
namespace {

// Narrow lobes receive light samples from lamps, but not from the probe
// (LightSource::mirrorAlpha).
BsdfValue narrowLobes(const Bsdf& bsdf, const vec3& wi) {
  if (!bsdf.has(Lobes::Narrow)) return {Rgb(0), 0};
  return bsdf.evaluate(wi, Lobes::Narrow);
}

}  // namespace

Rgb DirectLight::visibility(const Ray& ray, const Media& media, RayMask mask, uint32_t key,
                            const LightEnd& end) const {
  if (!exists(end, mask)) return Rgb(0);
  return throughEnd(world_.accel.transmittance(ray, mask, media.attenuation(), media.bodies()), ray,
                    media, mask, key, end);
}

Rgb DirectLight::throughEnd(const Rgb& passed, const Ray& ray, const Media& media, RayMask mask,
                            uint32_t key, const LightEnd& end) const {
  if (!exists(end, mask)) return Rgb(0);
  if (end.instance == LightEnd::kNone || isBlack(passed) ||
      !world_.sharedPlaces.contains(end.instance, end.triangle))
    return passed;
  const Hit emitter{end.instance, end.triangle, end.barycentric, ray.tMax};
  return passed * transmittanceAtPlace(world_, media, ray, emitter, key, mask);
}

Rgb DirectLight::visibility(const Ray& ray, const Media& media, PathContext& context,
                            const LightEnd& end) const {
  ++context.counts.shadow;
  if (context.log) context.log->rays.push_back({ray, true});
  const uint32_t key = context.sampler.sampleKey();
  const Rgb passed = visibility(ray, media, settings_.visible, key, end);
  const bool differs = settings_.compared != settings_.visible;
  // `compared` is a subset of `visible`: a ray unoccluded in `visible` is unoccluded there too.
  if (differs && (passed != Rgb(1) || !exists(end, settings_.compared))) [[unlikely]] {
    // The product over blended surfaces depends on their order by rounding errors.
    constexpr float kRounding = 1e-6f;
    const Rgb other = visibility(ray, media, settings_.compared, key, end);
    context.shadowsDiffer |= maxComponent(absolute(other - passed)) > kRounding;
  }
  return passed;
}

Rgb DirectLight::transmittance(const Vertex& vertex, const Ray& ray, PathContext& context,
                               const LightEnd& end) const {
  if (!vertex.media.inside() && !vertex.surface.material->extended)
    return visibility(ray, {}, context, end);
  Media media = vertex.media;
  media.follow(vertex.surface, ray.direction);
  Rgb passed(1);
  if (vertex.place && *vertex.place)
    passed = crossPlace(*vertex.place, ray.direction, ray.time, media);
  if (isBlack(passed)) return passed;
  return passed * visibility(ray, media, context, end);
}

Rgb DirectLight::crossPlace(Place place, const vec3& direction, float time, Media& media) const {
  const Scene& scene = world_.scene;
  Rgb passed(1);
  for (place.leave(direction); place; place.leave(direction)) {
    const Hit& hit = place.current();
    const Instance& instance = scene.instances[hit.instance];
    const Surface surface =
        surfaceAt(scene, instance, hit.triangle, hit.barycentric, -direction, 0, time);
    passed *= straightTransmittance(scene, instance, surface, direction);
    media.follow(surface, direction);
  }
  return passed;
}

bool DirectLight::guideChooses(const Vertex& vertex, const PathContext& context) {
  return vertex.region &&
         context.sampler.get1(dimension::kGuide) >= vertex.region->strategyFraction();
}

DirectLight::LightSample DirectLight::ofStrategy(const Vertex& vertex, const DirectionSample& own) {
  if (!vertex.region) return {own, own.pdf};
  const float pdf = vertex.region->pdf(own.pdf, own.wi);
  return {{own.wi, own.irradiance * (own.pdf / pdf), pdf}, own.pdf};
}

DirectLight::LightSample DirectLight::ofGuide(const GuideRegion& region,
                                              const DirectionTree::Sample& sample,
                                              const LightSource::Escaped& found) {
  const float pdf = region.pdf(found.pdf, sample.pdf);
  return {{sample.direction, found.radiance / pdf, pdf}, found.pdf};
}

// f cos with the MIS weight of a light sample: the factor of its irradiance.
Rgb DirectLight::weighted(const DirectionSample& light, const BsdfValue& bsdf) const {
  return bsdf.fCos * (light.isDelta ? 1 : lightSampleWeight(settings_.mis, light.pdf, bsdf.pdf));
}

// The record of a light sample that nothing blocks.
LightRecord DirectLight::record(const LightPoint& point, const LightSample& light,
                                const BsdfValue& bsdf) {
  const DirectionSample& s = light.direction;
  return {.position = point.position,
          .normal = point.normal,
          .direction = s.wi,
          .integrand = luminance(bsdf.fCos * s.irradiance) * s.pdf,
          .density = s.pdf + bsdf.pdf,
          .strategyPdf = light.strategyPdf,
          .bsdfPdf = bsdf.pdf};
}

// `weight`: the radiance at the camera per irradiance of the sample. `source`: as for
// LightGroups::rangeOf().
void DirectLight::addToGroups(std::optional<size_t> source, const LightPoint& point,
                              const DirectionSample& light, const Rgb& weight,
                              PathContext& context) const {
  if (light.isDelta || light.end.instance != LightEnd::kNone)
    return context.groups->addSample(source, light, weight * light.irradiance);
  const LightSource& lighting = source ? *world_.sources.all[*source] : lighting_;
  context.groups->addEscaped(lighting, source, point, light.wi, weight / light.pdf);
}

void DirectLight::addToGroups(const DeferredLight& light, const Rgb& passed,
                              PathContext& context) const {
  addToGroups({}, light.point, light.sample, light.scattered * passed, context);
}

Rgb DirectLight::probe(const Vertex& vertex, PathContext& context) const {
  Rgb sum(0);
  const auto add = [&](const LightSample& light) {
    const vec3& wi = light.direction.wi;
    const BsdfValue bsdf = vertex.bsdf.evaluate(wi);
    if (isBlack(bsdf.fCos)) return;
    const Rgb passed = transmittance(vertex, rayFrom(vertex.surface, wi), context);
    if (isBlack(passed)) return;
    const Rgb scattered = weighted(light.direction, bsdf) * passed;
    sum += scattered * light.direction.irradiance;
    if (context.groups) [[unlikely]]
      addToGroups({}, vertex.point, light.direction, vertex.throughput * scattered, context);
    if (context.records && !light.direction.isDelta)
      context.addRecord(record(vertex.point, light, bsdf), passed);
  };
  const bool guided = guideChooses(vertex, context);
  if (guided) {
    const auto chosen = vertex.region->tree().sample(context.sampler.get2(dimension::kLight));
    add(ofGuide(*vertex.region, chosen, lighting_.escaped(vertex.point, chosen.direction)));
    if (takesOneSample_) return sum;
  }
  std::vector<DirectionSample>& samples = context.lightSamples;
  samples.clear();
  lighting_.sample(vertex.point, context.sampler, samples);
  for (const DirectionSample& own : samples)
    if (own.isDelta)  // the guide does not find it
      add({own, own.pdf});
    else if (!guided)
      add(ofStrategy(vertex, own));
  return sum;
}

DirectionSample DirectLight::sampleOfStrategy(const LightPoint& point, PathContext& context) const {
  std::vector<DirectionSample>& samples = context.lightSamples;
  samples.clear();
  lighting_.sample(point, context.sampler, samples);
  return samples.empty() ? DirectionSample{} : samples.front();
}

void DirectLight::defer(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
                        PathContext& context) const {
  if (guideChooses(vertex, context)) {
    deferGuided(vertex, throughput, light, context);
  } else if (light.waits) {
    light.waiting = std::make_unique<WaitingVertex>(vertex);
  } else {
    if (!light.isDrawn) light.sample = sampleOfStrategy(vertex.point, context);
    deferDrawn(vertex, throughput, light, context);
  }
}

void DirectLight::deferGuided(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
                              PathContext& context) const {
  const auto chosen = vertex.region->tree().sample(context.sampler.get2(dimension::kLight));
  if (!(chosen.pdf > 0)) return;
  light.bsdf = vertex.bsdf.evaluate(chosen.direction);
  if (isBlack(light.bsdf.fCos)) return;
  light.hasShadowRay = true;
  light.shadowRay = rayFrom(vertex.surface, chosen.direction);
  light.point = vertex.point;
  light.region = vertex.region;
  light.treePdf = chosen.pdf;
  light.throughput = throughput;
}

void DirectLight::deferDrawn(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
                             PathContext& context) const {
  if (!(light.sample.pdf > 0)) return;
  const BsdfValue bsdf = vertex.bsdf.evaluate(light.sample.wi);
  if (isBlack(bsdf.fCos)) return;
  light.hasShadowRay = true;
  light.shadowRay = rayFrom(vertex.surface, light.sample.wi);
  if (context.groups) light.point = vertex.point;
  const LightSample sample = ofStrategy(vertex, light.sample);
  light.sample = sample.direction;
  light.scattered = throughput * weighted(sample.direction, bsdf);
  light.radiance = light.scattered * sample.direction.irradiance;
  if (context.records) light.record = record(vertex.point, sample, bsdf);
}

void DirectLight::completeWaiting(DeferredLight& light, PathContext& context) const {
  const auto at = std::move(light.waiting);
  deferDrawn({at->point, at->surface, at->guided, {}, at->region, at->throughput}, at->throughput,
             light, context);
}

void DirectLight::complete(const LightSource::Escaped& found, DeferredLight& light,
                           const PathContext& context) const {
  const LightSample sample =
      ofGuide(*light.region, {light.shadowRay.direction, light.treePdf}, found);
  light.sample = sample.direction;
  light.scattered = light.throughput * weighted(sample.direction, light.bsdf);
  light.radiance = light.scattered * sample.direction.irradiance;
  if (context.records) light.record = record(light.point, sample, light.bsdf);
}

Rgb DirectLight::ofScene(size_t source, const Vertex& vertex, PathContext& context) const {
  std::vector<DirectionSample>& samples = context.lightSamples;
  samples.clear();
  world_.sources.all[source]->sample(vertex.point, context.sampler, samples);
  Rgb sum(0);
  for (const DirectionSample& light : samples) {
    const bool isSurface = light.end.instance != LightEnd::kNone;
    if (isSurface && !(light.distance > vertex.surface.rayOffset)) continue;
    const BsdfValue broad = vertex.bsdf.evaluate(light.wi);
    const BsdfValue narrow = narrowLobes(vertex.bsdf.bsdf(), light.wi);
    if (isBlack(broad.fCos) && isBlack(narrow.fCos)) continue;
    // The end point is offset too, so that neither surface shadows itself.
    Ray ray = rayFrom(vertex.surface, light.wi, light.distance);
    if (isSurface) ray.endAt(light.end.position);
    const Rgb passed = transmittance(vertex, ray, context, light.end);
    const Rgb scattered = (weighted(light, broad) + weighted(light, narrow)) * passed;
    sum += scattered * light.irradiance;
    if (context.groups) [[unlikely]]
      addToGroups(source, vertex.point, light, vertex.throughput * scattered, context);
  }
  return sum;
}

}  // namespace chromeball

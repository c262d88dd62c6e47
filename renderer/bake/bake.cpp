// SPDX-License-Identifier: Apache-2.0
#include "bake/bake.h"

#include <atomic>
#include <bit>
#include <mutex>

#include "approximate/occlusion.h"
#include "base/parallel.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr int kProbingRays = 16;
constexpr uint64_t kProbingBlock = ~0ull;  // of the sampler, for isBuried()
constexpr uint32_t kMaxTable = 4096;       // points; more samples take another randomisation

bool hidesItsInside(const Material& material) {
  return material.alphaMode == AlphaMode::Opaque && !material.transmits();
}

// Nothing is absorbed on the way to the surface.
float distanceOf(const PathState& path) { return path.media.inside() ? 0.0f : 1.0f; }

}  // namespace

PathState pathTo(const Surface& surface, const vec3& view, const PathTracer& tracer,
                 const PathContext& context) {
  PathState path;
  path.media = Media::around(tracer.world(), rayFrom(surface, surface.geometricNormal),
                             context.sampler.sampleKey(), tracer.settings().visible);
  path.ray = {surface.position + distanceOf(path) * view, -view};
  return path;
}

Hit hitOf(const PathState& path, const BakePoint& point) {
  return {uint32_t(point.instance), point.triangle, point.barycentric, distanceOf(path)};
}

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
  const PathState state = pathTo(surface, surface.normal, tracer_, context);
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
  const PathState state = pathTo(surface, surface.normal, tracer_, context);
  return tracer_.follow(state, hitOf(state, point), context);
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

PointSamples::PointSamples(const PointLight& light, const std::vector<PlacedMesh>& meshes,
                           const std::vector<BakePoint>& points, uint32_t samples, int maxDepth,
                           uint64_t seed)
    : light_(light),
      meshes_(meshes),
      points_(points),
      seed_(seed),
      table_(std::bit_ceil(std::clamp(samples, 16u, kMaxTable)), dimension::tabulated(maxDepth + 1),
             seed) {}

PointSamples::Totals PointSamples::forPoints(const Estimate& estimate,
                                             const Progress& progress) const {
  Totals totals{std::vector<uint8_t>(points_.size()), {}, {}};
  PerThread<PointWorker> workers([&] {
    return PointWorker{{.sampler = PixelSampler(table_, seed_), .clamp = Clamp()}, {}};
  });
  std::atomic<size_t> finished = 0;
  std::mutex reporting;
  constexpr size_t kGrain = 16;
  parallelRanges(points_.size(), kGrain, [&](size_t begin, size_t end) {
    PointWorker& worker = workers.local();
    for (size_t i = begin; i < end; ++i) {
      const BakePoint& point = points_[i];
      const Surface surface = light_.surfaceAt(point);
      worker.context.sampler.startPixel(point.x, point.y, kProbingBlock);
      totals.isBuried[i] = light_.isBuried(point, surface, meshes_, worker.context);
      if (!totals.isBuried[i]) estimate(i, surface, worker);
    }
    const size_t count = finished += end - begin;
    if (std::unique_lock lock(reporting, std::try_to_lock); lock)
      progress(double(count) / double(points_.size()));
  });
  workers.forEach([&](const PointWorker& worker) {
    totals.invalid.add(worker.invalid);
    totals.rays.add(worker.context.counts);
  });
  light_.scene().checkTexels();
  return totals;
}

uint32_t PointSamples::forSamples(size_t index, uint32_t count, uint32_t part, uint32_t parts,
                                  PointWorker& worker, const std::function<Rgb()>& sample,
                                  const std::function<void(const Rgb&)>& add) const {
  const BakePoint& point = points_[index];
  PixelSampler& sampler = worker.context.sampler;
  uint32_t valid = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (i % table_.size() == 0)
      sampler.startPixel(point.x, point.y, parts * uint64_t(i / table_.size()) + part);
    sampler.startSample(i % table_.size());
    const Rgb found = sample();
    if (const auto defect = defectOf(found, false)) {
      worker.invalid.add(*defect, int(point.x), int(point.y));
      continue;
    }
    add(found);
    ++valid;
  }
  return valid;
}

BakeResult bake(const World& world, const LightSource& lighting,
                const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                const BakeSettings& settings, const Progress& progress) {
  const PathTracer tracer(
      world, lighting,
      {.mis = settings.mis, .maxDepth = settings.maxDepth, .estimateDepthCut = false});
  const PointLight light(tracer, settings.what, settings.distance);
  const PointSamples all(light, meshes, points, (settings.samples + 1) / 2, settings.maxDepth,
                         settings.seed);
  BakeResult result;
  result.points.resize(points.size());
  const auto estimate = [&](size_t i, const Surface& surface, PointWorker& worker) {
    for (uint32_t half = 0; half < 2; ++half) {
      glm::dvec3 sum(0);
      const uint32_t valid = all.forSamples(
          i, (settings.samples + 1 - half) / 2, half, 2, worker,
          [&] { return light.sample(points[i], surface, worker.context); },
          [&](const Rgb& found) { sum += glm::dvec3(found); });
      if (valid > 0) result.points[i].halves[half] = Rgb(sum / double(valid));
    }
  };
  const PointSamples::Totals totals = all.forPoints(estimate, progress);
  for (size_t i = 0; i < points.size(); ++i) result.points[i].buried = totals.isBuried[i];
  result.invalid = totals.invalid;
  result.rays = totals.rays;
  return result;
}

vec4 shownColor(const PointLight& light, const BakePoint& point, const Rgb& baked) {
  const Scene& scene = light.scene();
  const Instance& instance = scene.instances[size_t(point.instance)];
  const float alpha = surfaceAlpha(scene, instance, point.triangle, point.barycentric);
  if (light.what() != BakedLight::Irradiance) return vec4(baked, alpha);
  const vec3 normal = light.surfaceAt(point).geometricNormal;
  const Surface surface = surfaceAt(scene, instance, point.triangle, point.barycentric, normal,
                                    point.extent * point.extent);
  const Rgb emitted = surface.material->emits()
                          ? emittedRadiance(scene, instance, surface, surface.normal)
                          : Rgb(0);
  if (surface.material->unlit) return vec4(emitted, alpha);
  return vec4(materialAt(scene, surface).baseColor * baked * kInvPi + emitted, alpha);
}

bool countsForScale(const Scene& scene, int instance) {
  return !scene.materials[size_t(scene.instances[size_t(instance)].material)].emits();
}

float scaleOf(float maximum) {
  float scale = 1;
  while (scale < maximum && scale < 1e30f) scale *= 2;
  return scale;
}

}  // namespace chromeball

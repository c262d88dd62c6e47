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

namespace {

constexpr uint32_t kMaxTable = 4096;       // points; more samples take another randomisation
constexpr uint64_t kProbingBlock = ~0ull;  // of the sampler, for isBuried()

struct Worker {
  PathContext context;
  InvalidSamples invalid;
};

class Baker {
 public:
  Baker(const PathTracer& tracer, const std::vector<PlacedMesh>& meshes,
        const BakeSettings& settings)
      : light_(tracer, settings.what, settings.distance),
        meshes_(meshes),
        settings_(settings),
        table_(std::bit_ceil(std::clamp((settings.samples + 1) / 2, 16u, kMaxTable)),
               dimension::tabulated(settings.maxDepth + 1), settings.seed) {}

  Worker makeWorker() const {
    return {{.sampler = PixelSampler(table_, settings_.seed), .clamp = Clamp()}, {}};
  }

  PointResult bake(const BakePoint& point, Worker& worker) const {
    PointResult result;
    PathContext& context = worker.context;
    const Surface surface = light_.surfaceAt(point);
    context.sampler.startPixel(point.x, point.y, kProbingBlock);
    result.buried = light_.isBuried(point, surface, meshes_, context);
    if (result.buried) return result;
    for (uint32_t half = 0; half < 2; ++half) {
      glm::dvec3 sum(0);
      uint32_t valid = 0;
      for (uint32_t i = 0; i < (settings_.samples + 1 - half) / 2; ++i) {
        if (i % table_.size() == 0)
          context.sampler.startPixel(point.x, point.y, 2 * uint64_t(i / table_.size()) + half);
        context.sampler.startSample(i % table_.size());
        const Rgb found = light_.sample(point, surface, context);
        if (const auto defect = defectOf(found, false)) {
          worker.invalid.add(*defect, int(point.x), int(point.y));
          continue;
        }
        sum += glm::dvec3(found);
        ++valid;
      }
      if (valid > 0) result.halves[half] = Rgb(sum / double(valid));
    }
    return result;
  }

 private:
  PointLight light_;
  const std::vector<PlacedMesh>& meshes_;
  const BakeSettings& settings_;
  SobolTable table_;
};

}  // namespace

BakeResult bake(const World& world, const LightSource& lighting,
                const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                const BakeSettings& settings, const Progress& progress) {
  const PathTracer tracer(
      world, lighting,
      {.mis = settings.mis, .maxDepth = settings.maxDepth, .estimateDepthCut = false});
  const Baker baker(tracer, meshes, settings);
  BakeResult result;
  result.points.resize(points.size());
  PerThread<Worker> workers([&] { return baker.makeWorker(); });
  std::atomic<size_t> finished = 0;
  std::mutex reporting;
  constexpr size_t kGrain = 64;
  parallelRanges(points.size(), kGrain, [&](size_t begin, size_t end) {
    Worker& worker = workers.local();
    for (size_t i = begin; i < end; ++i) result.points[i] = baker.bake(points[i], worker);
    const size_t count = finished += end - begin;
    if (std::unique_lock lock(reporting, std::try_to_lock); lock)
      progress(double(count) / double(points.size()));
  });
  workers.forEach([&](const Worker& worker) {
    result.invalid.add(worker.invalid);
    result.rays.add(worker.context.counts);
  });
  world.scene.checkTexels();
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

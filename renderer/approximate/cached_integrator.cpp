// SPDX-License-Identifier: Apache-2.0
#include "approximate/cached_integrator.h"

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "scene/camera.h"
#include "transport/first_surface.h"

namespace chromeball {

CachedIntegrator::CachedIntegrator(const PathTracer& tracer, const IrradianceCache& cache)
    : tracer_(tracer),
      direct_(tracer.world(), tracer.lighting(), sourcesAlone(tracer.settings())),
      cache_(cache) {}

Sample CachedIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  context.sampler.startVertex(0);
  PathState state = camera.path();
  const auto first = firstSurface(tracer_, state, camera.hit, context);
  if (!first || !hasRecords(*first->surface.material))
    return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  const Bsdf bsdf = first->bsdf(tracer_, state);
  const auto diffuse = cached(bsdf, first->surface);
  if (!diffuse) return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  ++context.counts.camera;
  Rgb radiance = *diffuse;
  if (first->surface.material->emits())
    radiance += tracer_.foundEmission(state, first->surface, first->hit);
  Bsdf diffuseLobes = bsdf, otherLobes = bsdf;
  diffuseLobes.keepOnly({.diffuse = true, .specular = false, .straight = false});
  otherLobes.keepOnly({.diffuse = false, .specular = true});
  radiance += direct_.reflected(state, first->surface, diffuseLobes, context);
  context.sampler.startVertex(0);
  radiance += tracer_.reflected(state, first->surface, otherLobes, context);
  return context.clamp(radiance);
}

std::optional<Rgb> CachedIntegrator::cached(const Bsdf& bsdf, const Surface& surface) const {
  std::optional<Rgb> sum;
  for (const MapLobe& lobe : bsdf.mapLobes()) {
    if (!lobe.isDiffuse || isBlack(lobe.albedo)) continue;
    const auto irradiance = cache_.find(surface.position, lobe.direction);
    if (!irradiance) return {};
    sum = sum.value_or(Rgb(0)) + lobe.albedo * kInvPi * *irradiance;
  }
  return sum;
}

namespace {

constexpr int kCoarsest = 64, kFinest = 4;  // pixels between points of the first and the last pass
constexpr float kLeastReach = 3;            // of records, in pixels
constexpr size_t kLargestGroup = 64;        // of points that are tried together

// A point where the irradiance on one side of a surface is needed.
struct CachePoint {
  glm::uvec2 pixel;
  uint64_t lobe;  // of the pixel
  Surface surface;
  vec3 normal;
  float pixelWidth;  // metres
};

class CacheFiller {
 public:
  CacheFiller(IrradianceCache& cache, const PathTracer& tracer, const Camera& camera,
              glm::ivec2 imageSize, uint64_t seed)
      : cache_(cache),
        tracer_(tracer),
        size_(imageSize),
        cameraRays_(camera, float(imageSize.x) / float(imageSize.y)),
        strata_(hemisphereStrata(64 / (cache.error() * cache.error()))),
        table_(std::bit_ceil(uint32_t(strata_.count())),
               dimension::tabulated(dimension::kTabulatedVertices), seed),
        contexts_([this, seed] {
          return PathContext{.sampler = PixelSampler(table_, seed), .clamp = Clamp(std::nullopt)};
        }) {}

  // The points of the pass with that spacing that earlier passes have not had, in scanline order.
  std::vector<CachePoint> pointsOf(int spacing) {
    const int rows = (size_.y + spacing - 1) / spacing;
    std::vector<std::vector<CachePoint>> found(static_cast<size_t>(rows));
    parallelFor(0, rows, [&](int row) {
      const int y = row * spacing;
      for (int x = 0; x < size_.x; x += spacing) {
        const bool isOld = spacing < kCoarsest && x % (2 * spacing) == 0 && y % (2 * spacing) == 0;
        if (!isOld) addPoints(x, y, found[size_t(row)]);
      }
    });
    std::vector<CachePoint> points;
    for (const auto& row : found) points.insert(points.end(), row.begin(), row.end());
    return points;
  }

  // Tries a group of points: adds a record for each one that lacks one.
  void tryOut(std::span<const CachePoint> points) {
    std::vector<std::optional<IrradianceRecord>> made(points.size());
    parallelFor(size_t(0), points.size(), [&](size_t i) {
      if (!isCovered(points[i])) made[i] = recordOf(points[i]);
    });
    for (const auto& record : made)
      if (record) cache_.add(*record);
  }

  size_t groupSize() const { return std::clamp<size_t>(cache_.size(), 1, kLargestGroup); }

 private:
  void addPoints(int x, int y, std::vector<CachePoint>& out) {
    PathContext& context = contexts_.local();
    const glm::uvec2 pixel(x, y);
    context.sampler.startPixel(pixel.x, pixel.y, 0);
    context.sampler.startSample(0);
    const Ray ray = cameraRay(float(x) + 0.5f, float(y) + 0.5f);
    PathState state;
    state.ray = ray;
    const auto first =
        firstSurface(tracer_, state, tracer_.closestHit(state.ray, context), context);
    if (!first || !hasRecords(*first->surface.material)) return;
    const Ray next = cameraRay(float(x) + 1.5f, float(y) + 0.5f);
    const float pixelWidth = glm::length(next.origin + state.length * next.direction - ray.origin -
                                         state.length * ray.direction);
    const Bsdf bsdf = first->bsdf(tracer_, state);
    uint64_t count = 0;
    for (const MapLobe& lobe : bsdf.mapLobes())
      if (lobe.isDiffuse && !isBlack(lobe.albedo))
        out.push_back({pixel, count++, first->surface, lobe.direction, pixelWidth});
  }

  Ray cameraRay(float x, float y) const {
    Ray ray;
    cameraRays_.ray(x / float(size_.x), y / float(size_.y), ray.origin, ray.direction);
    return ray;
  }

  bool isCovered(const CachePoint& point) {
    const auto claimed = cache_.claimedRadius(point.surface.position, point.normal);
    if (!claimed) return false;
    PathContext& context = contexts_.local();
    context.sampler.startPixel(point.pixel.x, point.pixel.y, 0);
    context.sampler.startSample(0);
    const float distance = meanDistance(tracer_, point.surface, point.normal, context);
    return std::max(distance, leastRadius(point)) >= 0.5f * *claimed;
  }

  float leastRadius(const CachePoint& point) const {
    return kLeastReach * point.pixelWidth / cache_.error();
  }

  std::optional<IrradianceRecord> recordOf(const CachePoint& point) {
    auto record = gatherIrradiance(tracer_, point.surface, point.normal, strata_, point.pixel,
                                   1 + point.lobe, contexts_);
    if (!record) return {};
    record->leastRadius = leastRadius(point);
    if (record->radius < record->leastRadius) {
      // The irradiance changes less over the distances that the image shows.
      for (vec3& gradient : record->translation) gradient *= record->radius / record->leastRadius;
      record->radius = record->leastRadius;
    }
    return record;
  }

  IrradianceCache& cache_;
  const PathTracer& tracer_;
  glm::ivec2 size_;
  CameraRays cameraRays_;
  HemisphereStrata strata_;
  SobolTable table_;
  PathContexts contexts_;
};

}  // namespace

void fillCache(IrradianceCache& cache, const PathTracer& tracer, const Camera& camera,
               glm::ivec2 imageSize, uint64_t seed, const Progress& progress,
               const std::atomic<bool>& stop) {
  CacheFiller filler(cache, tracer, camera, imageSize, seed);
  const double pixels = double(imageSize.x) * imageSize.y / (kFinest * kFinest);
  double tried = 0;
  StopMonitor monitor(stop);
  const MonitoredWork work(&monitor);
  try {
    for (int spacing = kCoarsest; spacing >= kFinest; spacing /= 2) {
      const std::vector<CachePoint> points = filler.pointsOf(spacing);
      for (size_t i = 0; i < points.size();) {
        const size_t count = std::min(filler.groupSize(), points.size() - i);
        filler.tryOut(std::span(points).subspan(i, count));
        i += count, tried += double(count);
        progress(std::min(tried / pixels, 1.0));
      }
    }
  } catch (const Interrupted&) {  // the records so far are whole
  }
}

}  // namespace chromeball

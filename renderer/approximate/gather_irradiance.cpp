// SPDX-License-Identifier: Apache-2.0
#include "approximate/cached_integrator.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "film/film.h"
#include "math/vec.h"
#include "trace/accel.h"

namespace chromeball {
namespace {

// What one stratum sees.
struct Seen {
  Rgb radiance{0};            // reflected
  float distance = INFINITY;  // metres
};

class Hemisphere {
 public:
  Hemisphere(const HemisphereStrata& strata) : strata_(strata), seen_(size_t(strata.count())) {}

  Seen& at(int elevation, int azimuth) {
    return seen_[size_t(elevation * strata_.azimuths + azimuth)];
  }

  double inverseDistance() const {
    double sum = 0;
    for (const Seen& seen : seen_) sum += 1 / double(seen.distance);
    return sum / strata_.count();
  }

 private:
  HemisphereStrata strata_;
  std::vector<Seen> seen_;
};

// A unit direction for a point of [0, 1]^2, with density cos / pi.
vec3 cosineDirection(const Frame& frame, vec2 u) {
  const float sine = std::sqrt(u.x), cosine = std::sqrt(std::max(1 - u.x, 0.0f));
  const float phi = 2 * kPi * u.y;
  return frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

// Follows paths from a point that receives light, without what sourcesAlone() finds there.
class GatheredPath {
 public:
  // Both tracers must outlive this object.
  GatheredPath(const PathTracer& tracer, const PathTracer& sources)
      : tracer_(tracer), sources_(sources) {}

  // `hit`: the first one from the point, along the state's ray.
  Rgb follow(PathState state, std::optional<Hit> hit, PathContext& context) const {
    const vec3 start = state.from.position;
    while (hit) {
      state.radiance -= emissionAt(state, *hit, context);
      if (!tracer_.vertex(state, hit, context)) return state.radiance;
      context.sampler.startVertex(state.depth);
      hit = tracer_.nextHit(state, context);
      // Nothing is between the path and the point but smooth glass and surfaces passed straight.
      const bool isClear = state.isDelta || state.from.position == start;
      if (!isClear || state.bounces() != 1) return tracer_.follow(state, hit, context);
    }
    return state.radiance;
  }

 private:
  // The light of a source that the vertex adds to the path.
  Rgb emissionAt(PathState state, const Hit& hit, PathContext& context) const {
    const Scene& scene = tracer_.world().scene;
    const auto met = tracer_.metAt(state, hit, context);
    if (!met || !scene.materials[size_t(scene.instances[met->instance].material)].emits())
      return Rgb(0);
    const Rgb before = state.radiance;
    sources_.vertex(state, met, context);  // at its limit of depth: no light samples
    return state.radiance - before;
  }

  const PathTracer& tracer_;
  const PathTracer& sources_;
};

// The state's pdf of 0 leaves the light of sources to light samples.
Seen seenAlong(const PathTracer& tracer, const GatheredPath& path, const Surface& surface,
               const vec3& normal, const vec3& wi, PathContext& context) {
  if (glm::dot(wi, surface.geometricNormal) * glm::dot(normal, surface.geometricNormal) <= 0)
    return {};
  const PathState state{.ray = rayFrom(surface, wi),
                        .from = {surface.position, normal, nullptr, 0},
                        .isDelta = false,
                        .pdf = 0,
                        .lobes = Lobes::Broad,
                        .depth = 1,
                        .scattered = true};
  context.sampler.startVertex(state.depth);
  const auto hit = tracer.closestHit(state.ray, context);
  if (!hit) return {};
  return {path.follow(state, hit, context), hit->distance};
}

float distanceOf(const Seen& a, const Seen& b) { return std::min(a.distance, b.distance); }

// 0 where both are infinitely far.
Rgb change(const Seen& to, const Seen& from) {
  const float distance = distanceOf(to, from);
  return std::isinf(distance) ? Rgb(0) : (to.radiance - from.radiance) / distance;
}

// Sums over the strata j (elevation) and k (azimuth) of radiance L and distance r:
//   irradiance   E    = pi / (M N) sum L
//   rotation     dE   = pi / (M N) sum tan(theta) L v
//   translation  dE   = sum_k u 2 pi / N sum_j sin(theta) cos^2(theta) / min(r) (L_j - L_(j-1))
//                     + sum_k v sum_j (sin(theta_above) - sin(theta_below)) / min(r) (L_k -
//                     L_(k-1))
// with u towards an azimuth and v = n x u. Axes of rotation are n_i x n.
IrradianceRecord integrate(Hemisphere& seen, const HemisphereStrata& strata, const Frame& frame) {
  IrradianceRecord record;
  const auto horizontal = [&](double azimuth) {  // in units of strata
    const double phi = 2 * double(kPi) * azimuth / strata.azimuths;
    return frame.toWorld({float(std::cos(phi)), float(std::sin(phi)), 0});
  };
  const auto sineAt = [&](int boundary) { return std::sqrt(double(boundary) / strata.elevations); };
  const auto add = [](std::array<vec3, 3>& gradient, const Rgb& amount, const vec3& direction) {
    for (int c = 0; c < 3; ++c) gradient[size_t(c)] += amount[c] * direction;
  };
  const float perStratum = kPi / float(strata.count());
  for (int k = 0; k < strata.azimuths; ++k) {
    const int before = (k + strata.azimuths - 1) % strata.azimuths;
    const vec3 towards = horizontal(k + 0.5), across = horizontal(k + 0.5 + 0.25 * strata.azimuths);
    const vec3 acrossEdge = horizontal(k + 0.25 * strata.azimuths);
    for (int j = 0; j < strata.elevations; ++j) {
      const Seen& here = seen.at(j, k);
      const double squared = (j + 0.5) / strata.elevations;  // sin^2 of the middle
      record.irradiance += perStratum * here.radiance;
      add(record.rotation, perStratum * float(std::sqrt(squared / (1 - squared))) * here.radiance,
          across);
      const double low = sineAt(j), high = sineAt(j + 1);
      if (j > 0)
        add(record.translation,
            float(2 * double(kPi) / strata.azimuths * low * (1 - low * low)) *
                change(here, seen.at(j - 1, k)),
            towards);
      add(record.translation, float(high - low) * change(here, seen.at(j, before)), acrossEdge);
    }
  }
  return record;
}

// The radius where the irradiance changes faster than the distances suggest (Krivanek et al. 2006).
float radiusOfGradient(const IrradianceRecord& record) {
  const auto& t = record.translation;
  const glm::dvec3 gradient = 0.2126f * t[0] + 0.7152f * t[1] + 0.0722f * t[2];
  return float(double(luminance(record.irradiance)) / glm::length(gradient));  // squares: double
}

}  // namespace

PathSettings sourcesAlone(PathSettings settings) {
  settings.maxDepth = std::min(settings.maxDepth, 1);
  return settings;
}

HemisphereStrata hemisphereStrata(float samples) {
  const int elevations = std::max(int(std::lround(std::sqrt(samples / kPi))), 2);
  return {elevations, int(std::lround(kPi * float(elevations)))};
}

std::optional<IrradianceRecord> gatherIrradiance(const PathTracer& tracer, const Surface& surface,
                                                 const vec3& normal, const HemisphereStrata& strata,
                                                 glm::uvec2 pixel, uint64_t block,
                                                 PathContexts& contexts) {
  Hemisphere hemisphere(strata);
  const Frame frame(normal);
  const PathTracer sources(tracer.world(), tracer.lighting(), sourcesAlone(tracer.settings()));
  const GatheredPath path(tracer, sources);
  std::atomic<bool> valid = true;
  parallelAdaptiveRanges(size_t(strata.elevations), [&](size_t begin, size_t end) {
    PathContext& context = contexts.local();
    context.sampler.startPixel(pixel.x, pixel.y, block);
    for (int j = int(begin); j < int(end); ++j)
      for (int k = 0; k < strata.azimuths; ++k) {
        context.sampler.startSample(uint32_t(j * strata.azimuths + k));
        context.sampler.startVertex(0);
        const vec2 u = (vec2(j, k) + context.sampler.get2(dimension::kBsdf)) /
                       vec2(strata.elevations, strata.azimuths);
        Seen& seen = hemisphere.at(j, k);
        seen = seenAlong(tracer, path, surface, normal, cosineDirection(frame, u), context);
        if (defectOf(seen.radiance, true)) valid = false;
      }
  });
  if (!valid) return {};
  IrradianceRecord record = integrate(hemisphere, strata, frame);
  record.position = surface.position, record.normal = normal;
  record.radius = float(1 / hemisphere.inverseDistance());
  const float limit = radiusOfGradient(record);
  if (limit < record.radius) record.radius = limit;
  return record;
}

float meanDistance(const PathTracer& tracer, const Surface& surface, const vec3& normal,
                   PathContext& context) {
  constexpr HemisphereStrata kFew{4, 12};
  const Frame frame(normal);
  double inverse = 0;
  for (int j = 0; j < kFew.elevations; ++j)
    for (int k = 0; k < kFew.azimuths; ++k) {
      const vec2 u = (vec2(j, k) + 0.5f) / vec2(kFew.elevations, kFew.azimuths);
      const vec3 wi = cosineDirection(frame, u);
      if (const auto hit = tracer.closestHit(rayFrom(surface, wi), context))
        inverse += 1 / double(hit->distance);
    }
  return float(kFew.count() / inverse);
}

}  // namespace chromeball

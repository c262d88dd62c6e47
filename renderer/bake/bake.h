// SPDX-License-Identifier: Apache-2.0
// Estimates the light at many points, on all threads.
#pragma once

#include <functional>

#include "bake/bake_points.h"
#include "base/progress.h"
#include "film/film.h"
#include "transport/path.h"

namespace chromeball {

// Estimates the light at a point of a surface.

enum class BakedLight {
  Irradiance,        // of the front, W/m^2: pi times the radiance of a white Lambertian surface
  AmbientOcclusion,  // 1 / pi integral of V cos, V the visibility of the sky
  Radiance           // that the front emits and reflects along its normal
};
inline constexpr const char* kBakedLightNames[] = {"irradiance", "ambient-occlusion", "radiance"};

// A path that ends on the front of a surface, seen from `view`, unit, in the bodies around it.
PathState pathTo(const Surface& surface, const vec3& view, const PathTracer& tracer,
                 const PathContext& context);
// The hit at its end.
Hit hitOf(const PathState& path, const BakePoint& point);

class PointLight {
 public:
  // The tracer must outlive this. `distance`: surfaces farther away do not occlude, metres.
  PointLight(const PathTracer& tracer, BakedLight what, float distance)
      : tracer_(tracer), what_(what), distance_(distance) {}

  BakedLight what() const { return what_; }
  const Scene& scene() const { return tracer_.world().scene; }

  // The front of the surface with the interpolated normal; for radiance, with the material's
  // normal.
  Surface surfaceAt(const BakePoint& point) const;

  // One sample; uses the random numbers of a path.
  Rgb sample(const BakePoint& point, const Surface& surface, PathContext& context) const;

  // Whether the point is inside a body: most rays from it first hit the back of a closed surface,
  // or of any surface nearer than a texel. Glass and blended surfaces are not counted. Uses samples
  // of the current pixel.
  bool isBuried(const BakePoint& point, const Surface& surface,
                const std::vector<PlacedMesh>& meshes, PathContext& context) const;

 private:
  Rgb irradiance(const Surface& surface, PathContext& context) const;

  const PathTracer& tracer_;
  BakedLight what_;
  float distance_;
};

// The scratch of a thread.
struct PointWorker {
  PathContext context;
  InvalidSamples invalid;  // at the points' x and y
};

// The samples of all points, on all threads. Results depend on points, samples and seed only.
class PointSamples {
 public:
  // All arguments must outlive this. `meshes`: all instances of the world. `samples`: of a point,
  // or of each independent part of its samples.
  PointSamples(const PointLight& light, const std::vector<PlacedMesh>& meshes,
               const std::vector<BakePoint>& points, uint32_t samples, int maxDepth, uint64_t seed);

  struct Totals {
    std::vector<uint8_t> isBuried;  // by point: PointLight::isBuried()
    InvalidSamples invalid;
    RayCounts rays;
  };
  // Calls estimate(index, surface, worker), which may call forSamples(), for each point that is not
  // buried.
  using Estimate = std::function<void(size_t, const Surface&, PointWorker&)>;
  Totals forPoints(const Estimate& estimate, const Progress& progress) const;

  // Calls add(sample()) `count` times, with the random numbers of part `part` of `parts`, except
  // for invalid samples. Returns how many are valid.
  uint32_t forSamples(size_t point, uint32_t count, uint32_t part, uint32_t parts,
                      PointWorker& worker, const std::function<Rgb()>& sample,
                      const std::function<void(const Rgb&)>& add) const;

 private:
  const PointLight& light_;
  const std::vector<PlacedMesh>& meshes_;
  const std::vector<BakePoint>& points_;
  uint64_t seed_;
  SobolTable table_;
};

struct BakeSettings {
  BakedLight what = BakedLight::Irradiance;
  uint32_t samples = 256;  // of each point, >= 2
  uint64_t seed = 0;
  int maxDepth = 8;  // as PathSettings; 1: direct light
  Mis mis = Mis::Balance;
  float distance = INFINITY;  // of ambient occlusion, metres
};

struct PointResult {
  std::array<Rgb, 2> halves{};  // means of independent halves of the samples
  bool buried = false;          // inside a body: no light was estimated

  Rgb mean() const { return 0.5f * (halves[0] + halves[1]); }
};

struct BakeResult {
  std::vector<PointResult> points;  // as the points
  InvalidSamples invalid;           // at the points' x and y
  RayCounts rays;
};

// `meshes`: all instances of the world.
BakeResult bake(const World& world, const LightSource& lighting,
                const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                const BakeSettings& settings, const Progress& progress);

// Linear RGB and coverage at a point whose front has this light: for irradiance E, base colour x
// E / pi plus what the surface emits along its normal; for radiance the light itself; for occlusion
// its grey. The base colour is the mean over the point's extent.
vec4 shownColor(const PointLight& light, const BakePoint& point, const Rgb& baked);

// Whether the colours of an instance count for the scale of the file: emitting surfaces do not, so
// that lamps do not darken the rest.
bool countsForScale(const Scene& scene, int instance);

// The smallest power of two, from 1 up, that no channel exceeds.
float scaleOf(float maximum);

}  // namespace chromeball

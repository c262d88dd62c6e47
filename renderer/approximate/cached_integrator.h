// SPDX-License-Identifier: Apache-2.0
// Path tracing with the irradiance cache (HDRI book, section 9.5), and how the cache is filled.
#pragma once

#include <atomic>

#include "approximate/irradiance_cache.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "math/vec.h"
#include "transport/integrator.h"
#include "transport/path.h"

namespace chromeball {

// At the first surface, each diffuse lobe reflects the cached irradiance as if it arrived evenly
// from the hemisphere, instead of the light of other surfaces. The light of sources, also through
// clear sheets and bodies, and the light of specular lobes is path traced, as is everything where
// the cache has no record.
class CachedIntegrator : public SingleIntegrator {
 public:
  // All arguments must outlive this. The cache must not change meanwhile. The tracer does not
  // estimate the light beyond the limits of depth, and its paths have two bounces at least.
  CachedIntegrator(const PathTracer& tracer, const IrradianceCache& cache);

  Sample sample(const CameraSample& camera, PathContext& context) const override;

 private:
  // Radiance reflected by the diffuse lobes; nullopt if a record is missing or there are no such
  // lobes.
  std::optional<Rgb> cached(const Bsdf& bsdf, const Surface& surface) const;

  const PathTracer& tracer_;
  PathTracer direct_;  // finds the light of sources, which the records lack
  const IrradianceCache& cache_;
};

// Fills an irradiance cache with the records that one image needs.

// Whether records serve the diffuse lobes of a material. The diffuse lobes of a body of glass are
// path traced, together with the light that the glass transmits.
inline bool hasRecords(const Material& material) { return !material.unlit && !material.isBody(); }

// Adds records where the camera sees diffuse surfaces that the cache does not cover: at the centres
// of every 64th pixel, then of every 32nd, and so on to every 4th (progressive refinement). They
// are taken in groups, the first ones small, whose records are added together and in order, so that
// the cache depends on neither the threads nor a crop. A covered point also gets a record if a few
// rays see surfaces much nearer there than the records tell. Each record takes 64 / error^2 paths.
// Ends early if `stop` is set.
void fillCache(IrradianceCache& cache, const PathTracer& tracer, const Camera& camera,
               glm::ivec2 imageSize, uint64_t seed, const Progress& progress,
               const std::atomic<bool>& stop);

// Makes a record of the irradiance cache: samples the hemisphere above a point.

// Equal parts of the hemisphere as the cosine weighs it: sin^2 of the angle to the normal and the
// azimuth are divided evenly.
struct HemisphereStrata {
  int elevations, azimuths;

  int count() const { return elevations * azimuths; }
};

// About `samples` strata, nearly square: azimuths = pi elevations.
HemisphereStrata hemisphereStrata(float samples);

using PathContexts = PerThread<PathContext>;

// The settings of paths from a camera that see a surface and the light of sources that it reflects:
// all the light that records lack.
PathSettings sourcesAlone(PathSettings settings);

// The irradiance from light that surfaces reflect towards the point. Light of sources, also through
// clear sheets and bodies (sourcesAlone()), is left out: light samples find it better. Traces one
// path per stratum, in parallel; the record does not depend on the threads. `pixel`, `block`: the
// randomness, as in PixelSampler. For the gradients see Ward and Heckbert 1992 (equations 4 and 5).
// The radius is the harmonic mean distance, or less where the irradiance changes faster than that
// suggests. Nullopt if a path's radiance is not valid.
std::optional<IrradianceRecord> gatherIrradiance(const PathTracer& tracer, const Surface& surface,
                                                 const vec3& normal, const HemisphereStrata& strata,
                                                 glm::uvec2 pixel, uint64_t block,
                                                 PathContexts& contexts);

// Only the harmonic mean distance, from few rays, in metres; infinity if none hits anything.
float meanDistance(const PathTracer& tracer, const Surface& surface, const vec3& normal,
                   PathContext& context);

}  // namespace chromeball

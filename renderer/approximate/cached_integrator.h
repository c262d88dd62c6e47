// SPDX-License-Identifier: Apache-2.0
// Path tracing with the irradiance cache (HDRI book, section 9.5).
#pragma once

#include <atomic>

#include "approximate/irradiance_cache.h"
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

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Path tracing with the irradiance cache (HDRI book, section 9.5).
#pragma once

#include "integrate/integrator.h"
#include "integrate/irradiance_cache/irradiance_cache.h"

namespace chromeball {

// At the first surface, each diffuse lobe reflects the cached irradiance as if it arrived evenly
// from the hemisphere, instead of the light of other surfaces. The light of sources, also through
// clear sheets and bodies, and that of specular lobes is path traced, as is everything where the
// cache has no record.
class CachedIntegrator : public Integrator {
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

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Makes a record of the irradiance cache: samples the hemisphere above a point.
#pragma once

#include "approximate/irradiance_cache.h"
#include "base/parallel.h"
#include "transport/path.h"

namespace chromeball {

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

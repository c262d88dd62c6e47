// SPDX-License-Identifier: Apache-2.0
// Fills an irradiance cache with what one image needs.
#pragma once

#include <atomic>

#include "base/progress.h"
#include "integrate/irradiance_cache/irradiance_cache.h"
#include "integrate/path.h"
#include "integrate/render_settings.h"

namespace chromeball {

// Whether records serve the diffuse lobes of a material. Those of a body of glass are path traced
// together with what the glass transmits.
inline bool hasRecords(const Material& material) { return !material.unlit && !material.isBody(); }

// Adds records where the camera sees diffuse surfaces that the cache does not cover: at the centres
// of every 64th pixel, then of those half as far apart, and so on to every 4th (progressive
// refinement). They are taken in groups, the first ones small, whose records are added together and
// in order, so that the cache depends on neither the threads nor a crop. A covered point also gets
// a record if a few rays see surfaces much nearer there than the records tell.
// Each record takes 64 / error^2 paths. Ends early if `stop` is set.
void fillCache(IrradianceCache& cache, const PathTracer& tracer, const Camera& camera,
               const RenderSettings& settings, const Progress& progress,
               const std::atomic<bool>& stop);

}  // namespace chromeball

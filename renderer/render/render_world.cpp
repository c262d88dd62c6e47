// SPDX-License-Identifier: Apache-2.0
// Chooses the integrator for the settings.
#include <algorithm>
#include <cassert>

#include "approximate/cached_integrator.h"
#include "approximate/environment_map.h"
#include "approximate/occlusion.h"
#include "base/progress.h"
#include "render/render.h"
#include "transport/light_groups.h"

namespace chromeball {
namespace {

constexpr double kFillShare = 0.3;  // of the progress

// An estimate of the light beyond the limits of depth would lack the light in the records.
PathSettings withoutDepthCut(PathSettings settings) {
  settings.estimateDepthCut = false;
  return settings;
}

// The settings after `seconds` of the time limit.
RenderSettings after(double seconds, RenderSettings settings) {
  constexpr double kLeast = 1e-3;
  if (settings.timeLimit) settings.timeLimit = std::max(*settings.timeLimit - seconds, kLeast);
  return settings;
}

}  // namespace

RenderResult render(const World& world, const Camera& camera, const LightSource& lighting,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop, RenderControl* control, const RenderAids& aids) {
  const auto withLayers = [&](const Integrator& picture, GuideTraining* training,
                              const RenderSettings& limits, const Progress& rest) {
    if (!settings.wantsSurfaceLayers())
      return render(picture, world, camera, limits, rest, stop, training, control);
    const PathTracer tracer(world, lighting, settings.path());
    return render(SurfaceLayers(picture, tracer, settings.aovs, settings.occlusion), world, camera,
                  limits, rest, stop, training, control);
  };
  if (settings.usesEnvironmentMaps()) {
    assert(aids.environment);
    return withLayers(EnvironmentMapIntegrator(world, lighting, *aids.environment, settings.path(),
                                               settings.usedOcclusion()),
                      nullptr, settings, progress);
  }
  if (settings.usesCache()) {
    IrradianceCache own(*settings.cacheError);
    IrradianceCache& cache = aids.cache ? *aids.cache : own;
    const PathSettings paths = withoutDepthCut(settings.path());
    const Stopwatch watch;
    fillCache(
        cache, PathTracer(world, lighting, paths), camera, {settings.width, settings.height},
        settings.seed, [&](double fraction) { progress(kFillShare * fraction); }, stop);
    GuideTraining training(world, lighting, settings);
    const PathTracer tracer(world, lighting, training.guided(paths));
    const double filling = watch.seconds();
    RenderResult result =
        withLayers(CachedIntegrator(tracer, cache), &training, after(filling, settings),
                   [&](double fraction) { progress(kFillShare + (1 - kFillShare) * fraction); });
    if (result.overrun > 0) result.overrun += filling;
    return result;
  }
  GuideTraining training(world, lighting, settings);
  const PathTracer tracer(world, lighting, training.guided(settings.path()));
  if (!settings.wantsGroups())
    return withLayers(PathIntegrator(tracer), &training, settings, progress);
  const LightGroups groups(world, lighting);
  return withLayers(GroupIntegrator(tracer, groups), &training, settings, progress);
}

}  // namespace chromeball

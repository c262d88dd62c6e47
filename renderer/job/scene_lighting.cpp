// SPDX-License-Identifier: Apache-2.0
#include "job/scene_lighting.h"

#include <algorithm>

#include "base/error.h"
#include "lighting/finite_surroundings.h"
#include "lighting/scene_suns.h"

namespace chromeball {

void checkLit(const RenderJob& job, const Scene& scene) {
  const bool lit = !scene.lights.empty() || !sunsOf(job.file.lamps).empty() ||
                   std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const Material& m) { return m.emits(); });
  if (!lit)
    throw InputError(
        fmt::format("{}: nothing lights the scene; it needs a probe", job.file.models.front().file),
        Remedy{"probe.file", {}});
}

LoadedProbe loadProbeOf(const RenderJob& job, Scene& scene) {
  const SceneFile& file = job.file;
  const auto path = file.settings.getIfGiven<std::string>("probe.file");
  if (!path && scene.environment) {
    LoadedProbe own;
    own.latLong = std::move(*scene.environment);
    return own;
  }
  if (!path) {
    checkLit(job, scene);
    LoadedProbe black;
    black.latLong = Image(2, 1, 3);
    return black;
  }
  return loadProbe(*path, file.settings.get<std::string>("probe.mapping"),
                   file.settings.location("probe.mapping"));
}

Probe probeOf(const RenderJob& job, LoadedProbe& loaded) {
  const Settings& settings = job.file.settings;
  Probe probe(loaded.latLong, float(settings.get<double>("probe.rotation")),
              float(settings.get<double>("probe.scale")));
  loaded.latLong = {};
  return probe;
}

std::unique_ptr<LightingStrategy> makeLighting(const NamedSetting& strategy, Mis mis,
                                               const LoadedScene& loaded) {
  auto lighting = makeStrategy(strategy.name, loaded.probe,
                               {mis, loaded.sunAngle, loaded.showLights}, strategy.location);
  if (loaded.surroundings)
    lighting = std::make_unique<FiniteSurroundings>(std::move(lighting), loaded.probe,
                                                    *loaded.surroundings, loaded.room.get(),
                                                    loaded.showLights);
  if (loaded.suns.empty()) return lighting;
  return std::make_unique<SceneSuns>(std::move(lighting), loaded.suns);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/scene_sources.h"

#include "lighting/ambient_light.h"
#include "lighting/punctual.h"
#include "lighting/scene_suns.h"

namespace chromeball {

SceneSources::SceneSources(const Scene& scene) {
  const auto add = [&](auto source) {
    if (source) all.push_back(std::move(source));
  };
  auto surfaces = Emitters::make(scene);
  emitters = surfaces.get();
  add(std::move(surfaces));
  add(PunctualLights::make(scene));
  const auto addDistant = [&](auto source) {
    distant.push_back(all.size());
    all.push_back(std::move(source));
  };
  if (!scene.suns.empty()) addDistant(std::make_unique<SceneSuns>(scene.suns));
  for (const AmbientLamp& lamp : scene.ambient) addDistant(std::make_unique<AmbientLight>(lamp));
}

}  // namespace chromeball

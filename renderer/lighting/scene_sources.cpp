// SPDX-License-Identifier: Apache-2.0
#include "lighting/scene_sources.h"

#include "lighting/punctual.h"

namespace chromeball {

SceneSources::SceneSources(const Scene& scene) {
  const auto add = [&](auto source) {
    if (source) all.push_back(std::move(source));
  };
  auto surfaces = Emitters::make(scene);
  emitters = surfaces.get();
  add(std::move(surfaces));
  add(PunctualLights::make(scene));
}

}  // namespace chromeball

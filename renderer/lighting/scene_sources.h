// SPDX-License-Identifier: Apache-2.0
// The light sources that a scene has besides its probe.
#pragma once

#include <memory>
#include <vector>

#include "lighting/emitters.h"
#include "lighting/light_source.h"

namespace chromeball {

struct SceneSources {
  // One for each kind of source that occurs in the scene, which must outlive this.
  explicit SceneSources(const Scene& scene);

  std::vector<std::unique_ptr<const LightSource>> all;
  std::vector<size_t> distant;         // of these: those that rays find which hit nothing
  const Emitters* emitters = nullptr;  // of these: photons start there; null where nothing emits
};

}  // namespace chromeball

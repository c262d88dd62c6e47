// SPDX-License-Identifier: Apache-2.0
// The light sources that are in a scene, at a finite distance or of the model.
#pragma once

#include <memory>
#include <vector>

#include "lighting/emitters.h"
#include "lighting/strategy.h"

namespace chromeball {

struct SceneSources {
  // One for each kind of source that occurs in the scene, which must outlive this.
  explicit SceneSources(const Scene& scene);

  std::vector<std::unique_ptr<const LightingStrategy>> all;
  const Emitters* emitters = nullptr;  // of these: photons start there; null where nothing emits
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A probe as the approximate integrators use it.
#pragma once

#include <memory>
#include <optional>

#include "lighting/light_source.h"
#include "probe/prefiltered_probe.h"
#include "scene/scene.h"

namespace chromeball {

// Prefiltered maps for the roughnesses that occur in a scene. With `splitsSuns` the maps are of the
// probe without its suns, which are light sources of their own (HDRI book, section 9.8.2), with
// the diameter `sunAngle` in degrees if it is given, as in lighting/suns.h.
class EnvironmentLight {
 public:
  EnvironmentLight(const Probe& probe, const Scene& scene, bool splitsSuns,
                   std::optional<double> sunAngle = {});

  EnvironmentLight(const EnvironmentLight&) = delete;

  const PrefilteredProbe& maps() const { return maps_; }
  const LightSource* suns() const { return suns_.get(); }  // null: there are none

 private:
  struct Parts;
  EnvironmentLight(Parts parts, const Scene& scene);

  std::unique_ptr<const LightSource> suns_;
  Probe sharp_;
  PrefilteredProbe maps_;  // refers to sharp_
};

}  // namespace chromeball

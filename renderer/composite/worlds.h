// SPDX-License-Identifier: Apache-2.0
// Path tracing with and without the synthetic objects.
#pragma once

#include "composite/objects.h"
#include "transport/path.h"

namespace chromeball {

// Path tracers of both worlds of a composite. The camera does not see the probe, because the plate
// is the background.
struct CompositeWorlds {
  // `world` must have the masks of composite/objects.h; it and `lighting` must outlive this.
  CompositeWorlds(const World& world, const LightSource& lighting, PathSettings settings)
      : whole(world, lighting, with(settings, kAllInstances, kAllInstances)),
        local(world, lighting, with(settings, kLocalScene, kLocalScene)),
        shared(world, lighting, with(settings, kAllInstances, kLocalScene)) {}

  bool isObject(const Hit& hit) const { return whole.world().accel.mask(hit.instance) == kObjects; }

  PathTracer whole, local;
  PathTracer shared;  // as `whole`, and compares its shadow rays with those of `local`

 private:
  static PathSettings with(PathSettings settings, RayMask visible, RayMask compared) {
    settings.hideProbe = true;
    settings.visible = visible;
    settings.compared = compared;
    settings.estimateDepthCut = visible == kAllInstances;  // only for the world with objects
    return settings;
  }
};

}  // namespace chromeball

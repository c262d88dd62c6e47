// SPDX-License-Identifier: Apache-2.0
// Path tracing with the synthetic objects and without them.
#pragma once

#include "composite/objects.h"
#include "integrate/path.h"

namespace chromeball {

// Path tracers of both worlds of a composite. The camera never sees the probe: the plate is the
// background.
struct CompositeWorlds {
  // `world` has the masks of composite/objects.h; it and `lighting` must outlive this.
  CompositeWorlds(const World& world, const LightingStrategy& lighting, PathSettings settings)
      : whole(world, lighting, with(settings, kAllInstances, kAllInstances)),
        local(world, lighting, with(settings, kLocalScene, kLocalScene)),
        shared(world, lighting, with(settings, kAllInstances, kLocalScene)) {}

  bool isObject(const Hit& hit) const { return whole.world().accel.mask(hit.instance) == kObjects; }

  PathTracer whole, local;
  PathTracer shared;  // `whole`, whose shadow rays are also compared with those of `local`

 private:
  static PathSettings with(PathSettings settings, RayMask visible, RayMask compared) {
    settings.hideProbe = true;
    settings.visible = visible;
    settings.compared = compared;
    settings.estimateDepthCut = visible == kAllInstances;  // of the light with objects
    return settings;
  }
};

}  // namespace chromeball

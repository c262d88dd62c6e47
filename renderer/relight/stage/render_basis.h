// SPDX-License-Identifier: Apache-2.0
// Renders a light stage by bands of rows: all lighting conditions in one pass of path tracing.
#pragma once

#include <atomic>

#include "base/progress.h"
#include "lighting/probe_light.h"
#include "relight/stage/light_stage.h"
#include "render/render.h"
#include "transport/light_groups.h"

namespace chromeball {

struct BasisRender {
  LightStage stage;
  Image color;  // under unit radiance from everywhere, and the scene's own light
  InvalidSamples invalid;
  bool interrupted = false;
};

// The scene is lit from everywhere by radiance 1, as the strategy `uniform` samples it; the light
// that a path finds from a direction goes to the elements that are not 0 there. So a stage costs
// little more than a picture, and takes 12 bytes for each pixel and element. Only the settings of
// light and paths count, with the size, samples and seed; all pixels take the same number of
// samples.
class BasisRenderer {
 public:
  // `world` and `camera` must outlive this.
  BasisRenderer(const World& world, const Camera& camera, DirectionBasis basis,
                const RenderSettings& settings);
  BasisRenderer(const BasisRenderer&) = delete;
  BasisRenderer& operator=(const BasisRenderer&) = delete;

  // `count` rows of the picture from `top` on: the same bits in bands of any height. Ends early,
  // and reports that, if `stop` is set.
  BasisRender render(int top, int count, const Progress& progress,
                     const std::atomic<bool>& stop) const;

 private:
  const World& world_;
  const Camera& camera_;
  DirectionBasis basis_;
  RenderSettings settings_;
  Probe white_;
  Uniform lighting_;
  LightGroups groups_;
  PathTracer tracer_;
};

}  // namespace chromeball

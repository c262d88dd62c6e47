// SPDX-License-Identifier: Apache-2.0
// Renders a light stage: all lighting conditions in one pass of path tracing.
#pragma once

#include "base/progress.h"
#include "integrate/render.h"
#include "relight/light_stage.h"

namespace chromeball {

struct BasisRender {
  LightStage stage;
  Image color;  // under unit radiance from everywhere, and the scene's own light
  InvalidSamples invalid;
  RayCounts rays;
};

// The scene is lit from everywhere by radiance 1, as the strategy `uniform` samples it; what a path
// finds from a direction goes to the elements that are not 0 there. So a stage costs little more
// than a picture, and takes 12 bytes for each pixel and element. Of the settings, those of light
// and paths count, with the size, samples and seed; all pixels take the same number of samples.
BasisRender renderBasis(const World& world, const Camera& camera, const DirectionBasis& basis,
                        const RenderSettings& settings, const Progress& progress);

}  // namespace chromeball

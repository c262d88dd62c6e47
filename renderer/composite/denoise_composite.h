// SPDX-License-Identifier: Apache-2.0
// Removes the noise of what the objects add to a composite; the plate is not filtered.
#pragma once

#include "composite/compose.h"
#include "composite/render_composite.h"
#include "denoise/denoise.h"

namespace chromeball {

// The composite of the denoised radiance of the objects and of the denoised difference L_obj -
// L_noobj; for the ratio, L_noobj is denoised too. Alpha stays as it is. A pixel keeps the plate's
// bits where neither it nor a pixel around it (7 columns and rows) is affected by the objects, and
// where the camera sees no surface. A shadow catcher has no plate, which is empty. `render` must be
// of settings with `denoise`. nullopt if `stop` is set meanwhile.
std::optional<Denoised> denoiseComposite(const RenderResult& render, const Image& plate,
                                         CompositeMode mode, const Progress& progress,
                                         const std::atomic<bool>& stop);

}  // namespace chromeball

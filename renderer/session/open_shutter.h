// SPDX-License-Identifier: Apache-2.0
// How models, lamps and camera move while a description's shutter is open: they are read at equally
// spaced times, and move along straight lines between these (scene/motion.h).
#pragma once

#include "description/scene_entries.h"
#include "session/place_models.h"

#include <vector>

namespace chromeball {

// Gives the models, their lamps and the camera their motion. Warns where straight lines are far
// from it, and of parts and lamps that appear, vanish or become mirrored: those present when the
// shutter opens stay as they were, and no others appear. Throws InputError.
void openShutter(const RenderDescription& description, PlacedModels& placed, ModelCache& cache);

// The camera's turn around models that stand still. Returns warnings.
std::vector<std::string> turnCamera(const RenderDescription& description, const Scene& scene,
                                    const AutomaticView& view, const glm::dvec3& origin,
                                    Camera& camera);

// The times at which animated models look different.

struct ModelCache;

// The models whose animation is chosen, at another time, in seconds.
std::vector<ModelEntry> modelsAt(std::vector<ModelEntry> models, double seconds);

// The times, in seconds from the one that the models show and fewer than `seconds`, at which one of
// their animations has changed (animationChanges); of many, at most `most`, evenly chosen.
// Ascending. Throws InputError.
std::vector<double> timesOfChange(const std::vector<ModelEntry>& models, double seconds,
                                  size_t most, ModelCache& cache);

}  // namespace chromeball

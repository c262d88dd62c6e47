// SPDX-License-Identifier: Apache-2.0
// The times at which animated models look different.
#pragma once

#include <vector>

#include "description/scene_entries.h"

namespace chromeball {

struct ModelCache;

// The models whose animation is chosen, at another time, in seconds.
std::vector<ModelEntry> modelsAt(std::vector<ModelEntry> models, double seconds);

// The times, in seconds from the one that the models show and fewer than `seconds`, at which one of
// their animations has changed (animationChanges); of many, at most `most`, evenly chosen.
// Ascending. Throws InputError.
std::vector<double> timesOfChange(const std::vector<ModelEntry>& models, double seconds,
                                  size_t most, ModelCache& cache);

}  // namespace chromeball

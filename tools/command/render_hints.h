// SPDX-License-Identifier: Apache-2.0
// Messages to the user about a rendered image, with suggestions of options.
#pragma once

#include "session/render_loaded.h"

namespace chromeball {

// The messages of `result`, and messages about excluded samples, clamped light, light beyond the
// depth limits, and images that are nearly black or mostly clipped.
Messages resultMessages(const LoadedScene& loaded, const PreparedScene& prepared,
                        const FinishedRender& result);

// The option that sets a limit of depth, as it is typed: "--max-depth 8", "--integrator direct".
std::string limitGiven(DepthLimit limit, const RenderSettings& settings);

// Only the messages about excluded samples and clamped light.
void addExcluded(const RenderResult& result, Messages& messages);

}  // namespace chromeball

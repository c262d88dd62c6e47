// SPDX-License-Identifier: Apache-2.0
// Renders a job with [composite].
#pragma once

#include "session/run_job.h"

namespace chromeball {

// Estimates the local scene's reflectance if the job requests it, then renders the composite.
JobResult renderComposite(const LoadedScene& loaded, const PreparedScene& prepared,
                          const Progress& progress, const std::atomic<bool>& stop,
                          RenderControl* control);

}  // namespace chromeball

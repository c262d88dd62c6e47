// SPDX-License-Identifier: Apache-2.0
// What a user should know about a rendered image, with the options that help.
#pragma once

#include "job/run_job.h"

namespace chromeball {

// The messages of `result`, and of what its numbers show: samples left out, clamped light, light
// beyond the maximum depths, images that are nearly black or mostly clipped.
Messages resultMessages(const RenderJob& job, const LoadedScene& loaded,
                        const PreparedScene& prepared, const JobResult& result);

}  // namespace chromeball

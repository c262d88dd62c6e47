// SPDX-License-Identifier: Apache-2.0
// The output files of a job: images and statistics.
#pragma once

#include "base/message.h"
#include "description/render_description.h"

namespace chromeball {

// Checks, before rendering, that the outputs can be written. Returns warnings about settings that
// have no effect. Throws InputError or RunError.
Messages checkOutputs(const RenderDescription& job);

// Call when all files are read (`inputs`; the scene file itself is added) and no other input error
// can occur. Throws InputError if an output would overwrite an input, and makes the folders that
// the scene file names for its images.
void prepareOutputs(const RenderDescription& job, std::vector<std::string> inputs);

}  // namespace chromeball

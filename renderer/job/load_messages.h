// SPDX-License-Identifier: Apache-2.0
// Messages to the user about the files of a job.
#pragma once

#include "job/load_scene.h"

namespace chromeball {

// Messages about the job's settings, the models (`modelWarnings`: unsupported contents of their
// files), the probe and the plate.
Messages loadMessages(const RenderJob& job, const LoadedScene& loaded,
                      const std::vector<std::string>& modelWarnings);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What a user should know about the files of a job.
#pragma once

#include "job/load_scene.h"

namespace chromeball {

// Of the job's settings, the models (`modelWarnings`: what their files hold that is not rendered),
// the probe and the plate.
Messages loadMessages(const RenderJob& job, const LoadedScene& loaded,
                      const std::vector<std::string>& modelWarnings);

}  // namespace chromeball

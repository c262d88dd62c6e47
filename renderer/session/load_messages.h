// SPDX-License-Identifier: Apache-2.0
// Messages to the user about the files of a job.
#pragma once

#include "session/load_scene.h"

namespace chromeball {

// Messages about the job's settings, the models, the probe and the plate.
Messages loadMessages(const LoadedScene& loaded);

}  // namespace chromeball

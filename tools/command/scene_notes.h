// SPDX-License-Identifier: Apache-2.0
// What is said about a scene before it is rendered, beyond what loading it found.
#pragma once

#include "session/load_scene.h"

namespace chromeball {

// Notes: the camera, if none was asked for; a limit of noise that may have been meant in another
// unit.
Messages sceneNotes(const LoadedScene& loaded);

}  // namespace chromeball

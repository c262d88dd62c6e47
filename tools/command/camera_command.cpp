// SPDX-License-Identifier: Apache-2.0
#include "camera_commands.h"
#include "commands.h"

namespace chromeball {

void addCameraCommand(Command app) {
  Command camera = app.addCommand("camera", "Find the cameras of photographs.");
  camera.requiresCommand();
  addCameraSolveCommand(camera);
}

}  // namespace chromeball

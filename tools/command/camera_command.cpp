// SPDX-License-Identifier: Apache-2.0
#include "camera_commands.h"
#include "commands.h"

namespace chromeball {

void addCameraCommand(CLI::App& app) {
  CLI::App* camera = app.add_subcommand("camera", "Find the cameras of photographs.");
  camera->require_subcommand(1);
  addCameraSolveCommand(*camera);
}

}  // namespace chromeball

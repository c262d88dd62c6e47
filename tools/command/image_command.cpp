// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "image_commands.h"

namespace chromeball {

void addImageCommand(CLI::App& app) {
  CLI::App* image = app.add_subcommand("image", "View and compare images.");
  image->require_subcommand(1);
  addImageDenoiseCommand(*image);
  addImageDevelopCommand(*image);
  addImageDivideCommand(*image);
  addImageErrorCommand(*image);
  addImageFlatFieldCommand(*image);
  addImageRelightCommand(*image);
  addImageViewCommand(*image);
}

}  // namespace chromeball

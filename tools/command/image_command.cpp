// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "image_commands.h"

namespace chromeball {

void addImageCommand(Command app) {
  Command image = app.addCommand("image", "View and compare images.");
  image.requiresCommand();
  addImageDenoiseCommand(image);
  addImageDevelopCommand(image);
  addImageDivideCommand(image);
  addImageErrorCommand(image);
  addImageFlatFieldCommand(image);
  addImageRelightCommand(image);
  addImageViewCommand(image);
}

}  // namespace chromeball

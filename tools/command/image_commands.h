// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball image`.
#pragma once

#include "command.h"

namespace chromeball {

void addImageDenoiseCommand(Command image);
void addImageDevelopCommand(Command image);
void addImageDivideCommand(Command image);
void addImageErrorCommand(Command image);
void addImageFlatFieldCommand(Command image);
void addImageRelightCommand(Command image);
void addImageViewCommand(Command image);

}  // namespace chromeball

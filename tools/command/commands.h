// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball`, one file each. Each adds itself to the command line; its
// callback throws InputError or RunError.
#pragma once

#include "command.h"

namespace chromeball {

void addRenderCommand(Command app);
void addMergeCommand(Command app);
void addCompareCommand(Command app);
void addBakeCommand(Command app);
void addBasisCommand(Command app);
void addRelightCommand(Command app);
void addProbeCommand(Command app);   // info, convert, synth, irradiance
void addImageCommand(Command app);   // view, error
void addCameraCommand(Command app);  // solve
void addLightsCommand(Command app);
void addLightsErrorCommand(Command app);
void addReferenceCommand(Command app);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball probe`.
#pragma once

#include "command.h"

namespace chromeball {

void addProbeInfoCommand(Command probe);
void addProbeConvertCommand(Command probe);
void addProbeConvolveCommand(Command probe);
void addProbeAssembleCommand(Command probe);
void addProbeReflectivityCommand(Command probe);
void addProbeSynthCommand(Command probe);
void addProbeEditCommand(Command probe);
void addProbeIrradianceCommand(Command probe);
void addProbeRaysCommand(Command probe);
void addProbePlotCommand(Command probe);
void addProbeMergeCommand(Command probe);
void addProbeSplitCommand(Command probe);
void addProbeAddSunCommand(Command probe);
void addProbeAlignCommand(Command probe);
void addProbeStitchCommand(Command probe);
void addProbeSunCommand(Command probe);

}  // namespace chromeball

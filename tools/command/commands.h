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
void addCameraCommand(Command app);
void addLightsCommand(Command app);
void addLightsErrorCommand(Command app);
void addReferenceCommand(Command app);
void addInfoCommand(Command app);
void addDoctorCommand(Command app);

// Of `chromeball probe`.
void addProbeInfoCommand(Command probe);
void addProbeConvertCommand(Command probe);
void addProbeConvolveCommand(Command probe);
void addProbeAssembleCommand(Command probe);
void addProbeReflectivityCommand(Command probe);
void addProbeSynthCommand(Command probe);
void addProbeEditCommand(Command probe);
void addProbeMergeCommand(Command probe);
void addProbeSunCommand(Command probe);
void addProbeSplitCommand(Command probe);
void addProbeAddSunCommand(Command probe);
void addProbeAlignCommand(Command probe);
void addProbeStitchCommand(Command probe);
void addProbeCropCommand(Command probe);
void addProbeSpheresCommand(Command probe);
void addProbeIrradianceCommand(Command probe);
void addProbeRaysCommand(Command probe);
void addProbePlotCommand(Command probe);

// Of `chromeball image`.
void addImageDenoiseCommand(Command image);
void addImageDevelopCommand(Command image);
void addImageDivideCommand(Command image);
void addImageErrorCommand(Command image);
void addImageFlatFieldCommand(Command image);
void addImageRelightCommand(Command image);
void addImageViewCommand(Command image);

}  // namespace chromeball

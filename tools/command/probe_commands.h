// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball probe`.
#pragma once

#include <CLI/CLI.hpp>

namespace chromeball {

void addProbeInfoCommand(CLI::App& probe);
void addProbeConvertCommand(CLI::App& probe);
void addProbeConvolveCommand(CLI::App& probe);
void addProbeAssembleCommand(CLI::App& probe);
void addProbeReflectivityCommand(CLI::App& probe);
void addProbeSynthCommand(CLI::App& probe);
void addProbeEditCommand(CLI::App& probe);
void addProbeIrradianceCommand(CLI::App& probe);
void addProbeRaysCommand(CLI::App& probe);
void addProbePlotCommand(CLI::App& probe);
void addProbeMergeCommand(CLI::App& probe);
void addProbeSplitCommand(CLI::App& probe);
void addProbeAddSunCommand(CLI::App& probe);
void addProbeAlignCommand(CLI::App& probe);
void addProbeStitchCommand(CLI::App& probe);
void addProbeSunCommand(CLI::App& probe);

}  // namespace chromeball

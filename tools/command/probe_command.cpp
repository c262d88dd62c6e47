// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "probe_commands.h"

namespace chromeball {

void addProbeCommand(CLI::App& app) {
  CLI::App* probe = app.add_subcommand("probe", "Inspect, convert and make light probes.");
  probe->require_subcommand(1);
  addProbeInfoCommand(*probe);
  addProbeConvertCommand(*probe);
  addProbeConvolveCommand(*probe);
  addProbeAssembleCommand(*probe);
  addProbeReflectivityCommand(*probe);
  addProbeSynthCommand(*probe);
  addProbeEditCommand(*probe);
  addProbeMergeCommand(*probe);
  addProbeSunCommand(*probe);
  addProbeSplitCommand(*probe);
  addProbeAddSunCommand(*probe);
  addProbeAlignCommand(*probe);
  addProbeStitchCommand(*probe);
  addProbeIrradianceCommand(*probe);
  addProbeRaysCommand(*probe);
  addProbePlotCommand(*probe);
}

}  // namespace chromeball

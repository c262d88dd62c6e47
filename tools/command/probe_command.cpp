// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "probe_commands.h"

namespace chromeball {

void addProbeCommand(Command app) {
  Command probe = app.addCommand("probe", "Inspect, convert and make light probes.");
  probe.requiresCommand();
  addProbeInfoCommand(probe);
  addProbeConvertCommand(probe);
  addProbeConvolveCommand(probe);
  addProbeAssembleCommand(probe);
  addProbeReflectivityCommand(probe);
  addProbeSynthCommand(probe);
  addProbeEditCommand(probe);
  addProbeMergeCommand(probe);
  addProbeSunCommand(probe);
  addProbeSplitCommand(probe);
  addProbeAddSunCommand(probe);
  addProbeAlignCommand(probe);
  addProbeStitchCommand(probe);
  addProbeIrradianceCommand(probe);
  addProbeRaysCommand(probe);
  addProbePlotCommand(probe);
}

}  // namespace chromeball

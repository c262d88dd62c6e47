// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball`, one file each. Each adds itself to the command line; its
// callback throws InputError or RunError.
#pragma once

#include <CLI/CLI.hpp>

namespace chromeball {

void addRenderCommand(CLI::App& app);
void addMergeCommand(CLI::App& app);
void addCompareCommand(CLI::App& app);
void addBakeCommand(CLI::App& app);
void addBasisCommand(CLI::App& app);
void addRelightCommand(CLI::App& app);
void addProbeCommand(CLI::App& app);   // info, convert, synth, irradiance
void addImageCommand(CLI::App& app);   // view, error
void addCameraCommand(CLI::App& app);  // solve
void addLightsCommand(CLI::App& app);
void addLightsErrorCommand(CLI::App& app);
void addReferenceCommand(CLI::App& app);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The options of every command that renders a scene.
#pragma once

#include <CLI/CLI.hpp>

#include "job/render_job.h"

namespace chromeball {

// Fills `options` when the command line is parsed; both must live as long.
void addSceneOptions(CLI::App& command, RenderOptions& options);

}  // namespace chromeball

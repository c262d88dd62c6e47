// SPDX-License-Identifier: Apache-2.0
// The options of the commands that render a scene, from the table of settings.
#pragma once

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "job/settings.h"

namespace chromeball {

struct SceneOptions {
  std::string scene;
  Settings settings;  // as the command line gives them; locations are "--size"

  bool quiet() const { return settings.get<bool>("quiet"); }
  bool showsProgress() const;
};

// Which command the options are for: compare varies some settings itself, and has no use for
// others.
enum class SceneCommand { Render, Compare };

// Fills `options` when the command line is parsed; both must live as long.
void addSceneOptions(CLI::App& app, SceneOptions& options, SceneCommand command);

// "--probe-scale FACTOR", or with a value "--probe-scale 2".
std::string optionText(const Setting& setting, const std::string& value = "");

}  // namespace chromeball

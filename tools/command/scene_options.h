// SPDX-License-Identifier: Apache-2.0
// The options of the commands that render a scene, from the table of settings.
#pragma once

#include "command.h"

#include "base/error.h"
#include "front/settings.h"

namespace chromeball {

struct SceneOptions {
  std::string scene;
  Settings settings;  // from the command line; locations are option names ("--size")

  bool quiet() const { return settings.get<bool>("quiet"); }
  bool showsProgress() const;
};

// The command that the options are for: compare varies some settings itself, and does not need
// others; bake and basis need few.
enum class SceneCommand { Render, Compare, Bake, Basis, BasisVertices };

bool isOptionOf(SceneCommand command, const Setting& setting);

// `options` is filled when the command line is parsed; it must outlive `app`.
void addSceneOptions(Command app, SceneOptions& options, SceneCommand command);

// "--probe-scale R[,G,B]", or with a value "--probe-scale 2".
std::string optionText(const Setting& setting, const std::string& value = "");

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The options of the commands that render a scene, from the table of settings; and the settings
// that each takes from a scene file.
#pragma once

#include "bake/placed_mesh.h"
#include "base/error.h"
#include "base/parallel.h"
#include "command.h"
#include "front/scene_file.h"
#include "front/settings.h"

namespace chromeball {

struct LoadedScene;

struct SceneOptions {
  std::string scene;
  Settings settings;  // from the command line; locations are option names ("--size")
};

// The command that the options are for: compare varies some settings itself, and does not need
// others; bake and basis need few.
enum class SceneCommand { Render, Compare, Bake, Basis, BasisVertices };

bool isOptionOf(SceneCommand command, const Setting& setting);

// `options` is filled when the command line is parsed; it must outlive `app`. `examples`: of the
// brief help.
void addSceneOptions(Command app, SceneOptions& options, SceneCommand command,
                     const std::string& examples = "");

// The same for one setting that has an option.
void addSettingOption(Command app, const Setting& setting, Settings& settings);

// "--probe-scale R[,G,B]", or with a value "--probe-scale 2".
std::string optionText(const Setting& setting, const std::string& value = "");

// Of --threads; 0 in the settings: no limit.
inline ThreadLimit threadLimit(const Settings& settings) {
  return ThreadLimit(settings.get<uint64_t>("threads"));
}

// Removes the settings of the file that have no effect on the command's output, so that they have
// none by accident either, and adds a warning that names the ones that would change an image.
void dropUnheeded(SceneFile& scene, SceneCommand command);

// Removes all that says how light reaches the models, on which their occlusion does not depend, and
// adds a warning that names what `options` had of it.
void dropLight(SceneFile& scene, Settings& options);

// Throws InputError unless these bytes fit into the memory beside the scene; `what` takes them.
void checkMemoryWithScene(const LoadedScene& loaded, double bytes, const std::string& what);

// placedMeshes(), for results at the vertices or texels of each instance, after a check of the
// memory that they take.
std::vector<PlacedMesh> placedWithinMemory(const LoadedScene& loaded);

}  // namespace chromeball

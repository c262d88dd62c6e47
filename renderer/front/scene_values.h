// SPDX-License-Identifier: Apache-2.0
// Scenes and settings from values in memory, such as a program's, with the keys and the checks of
// scene files. Messages call them by a name, and relative paths are seen from the working folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "front/scene_file.h"
#include "front/toml_section.h"

namespace chromeball {

// The scene of such a table, which may have no model. `path`: of a file that it was read from, or
// the scene's name. Throws InputError.
SceneFile sceneOf(toml::table table, const std::string& path);

// Replaces the camera of a scene by a section [camera]. Throws InputError.
void replaceCamera(SceneFile& scene, const toml::table& camera, const std::string& name);

// The settings that a program gives by keywords: the options of `chromeball render` with
// underscores ("max_depth"), but `layers` for its --aov. Those of the command's own files and
// displays are none.
std::vector<std::string_view> keywords();
// Throws InputError, begun by `name`, for an unknown keyword, with the nearest known one or where
// it belongs.
Settings keywordSettings(const toml::table& values, const std::string& name);

const Setting* findKeyword(std::string_view keyword);  // nullptr: there is none

// The keyword of a setting by its name in the table; that name if it has none.
std::string keywordOf(std::string_view setting);

}  // namespace chromeball

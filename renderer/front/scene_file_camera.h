// SPDX-License-Identifier: Apache-2.0
// The section [camera] of a scene file, also in a file of its own.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"

namespace chromeball {

// Throws InputError.
void readCamera(const Section& section, SceneFile& scene);

// Replaces the camera of `scene` by that of a file with nothing but [camera] with `position` and
// `look_at`, as `chromeball camera solve` writes it. Throws InputError.
void readCameraFile(const std::string& path, SceneFile& scene);

}  // namespace chromeball

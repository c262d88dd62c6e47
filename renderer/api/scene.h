// SPDX-License-Identifier: Apache-2.0
// Scenes from memory: meshes, materials, textures, lamps, cameras.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/scene.h"

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "scene/builder/scene_builder.h"

namespace chromeball::python {

namespace nb = nanobind;

// A material of the scene, from the keywords of chromeball.Material: numbers, colours, names and
// textures. Throws InputError for an unknown keyword, with the nearest known one. (SceneBuilder
// checks the values.)
Material materialOf(const nb::dict& keywords, SceneBuilder& builder);

std::vector<std::string> materialKeywords();

}  // namespace chromeball::python

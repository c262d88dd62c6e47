// SPDX-License-Identifier: Apache-2.0
// What comparisons take from those of `chromeball compare`.
#pragma once

#include <string>

#include "front/scene_file.h"

namespace chromeball::python {

// Drops settings of the scene that a comparison varies or ignores. Throws InputError, begun by
// `caller`, if one of them is given by a keyword, and for a scene with a composite.
void keepCompared(SceneFile& scene, const Settings& given, const std::string& caller);

}  // namespace chromeball::python

// SPDX-License-Identifier: Apache-2.0
// Distinguishes the local scene (a model of real surfaces in the plate) from the synthetic objects.
#pragma once

#include <vector>

#include "base/named_setting.h"
#include "composite/objects.h"
#include "scene/scene.h"

namespace chromeball {

// The nodes in `names` and all their descendants are the local scene; all other instances are
// objects. Throws InputError for an unknown name (with the nearest known one), and if there are no
// objects (message beginning with `location`).
ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location);

}  // namespace chromeball

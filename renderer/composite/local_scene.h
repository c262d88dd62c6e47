// SPDX-License-Identifier: Apache-2.0
// Tells the local scene, which stands for real things, from the synthetic objects.
#pragma once

#include <vector>

#include "base/named_setting.h"
#include "composite/objects.h"
#include "scene/scene.h"

namespace chromeball {

// True for the instances under none of the nodes `names`; a node's name speaks for all below it.
// Throws InputError for a name that no node has (with the nearest one), and where nothing is left
// to be put into the picture (beginning with `location`).
ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location);

}  // namespace chromeball

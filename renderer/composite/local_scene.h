// SPDX-License-Identifier: Apache-2.0
// Which parts of a model stand for real things.
#pragma once

#include <vector>

#include "base/named_setting.h"
#include "composite/differential_path.h"

namespace chromeball {

// True for the instances under none of the nodes `names`; a node's name speaks for all below it.
// Throws InputError for a name that no node has (with the nearest one), and where nothing is left
// to be put into the picture (beginning with `location`).
ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The parts of a description that are not values of options.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include "description/render_description.h"

namespace chromeball {

// Adds a hash of each part that is no option (describe.h), if there is any.
void addParts(const RenderDescription& description, nlohmann::ordered_json& to);

}  // namespace chromeball

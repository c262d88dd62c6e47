// SPDX-License-Identifier: Apache-2.0
// The words of other renderers and image tools for the settings of this one.
#pragma once

#include <string_view>

#include "front/setting.h"

namespace chromeball {

// Words may have dashes before or in them, underscores, and capitals: "--spp", "sample_count".

// The setting, which has an option, that others call so; nullptr if unknown.
const Setting* settingCalled(std::string_view word);

// Where to find what others call so and no setting is: "materials are the model's". Empty if
// unknown.
std::string_view placeOf(std::string_view word);

}  // namespace chromeball

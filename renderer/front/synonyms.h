// SPDX-License-Identifier: Apache-2.0
// The words of other renderers and image tools for the settings of this one.
#pragma once

#include <string>
#include <string_view>

#include "front/setting.h"

namespace chromeball {

// Words may have dashes before or in them, underscores, and capitals: "--spp", "sample_count".

// The setting, which has an option, that others call so; nullptr if unknown.
const Setting* settingCalled(std::string_view word);

// The same for options that are no settings, and for those that stand in for a setting where a
// command lacks it: "progress", "samples". Empty if unknown.
std::string_view optionCalled(std::string_view word);

// What a key of a table that there are many of ([[light]]) is, which others call so, as the end of
// a message; empty if unknown.
std::string hintOnListKey(std::string_view section, std::string_view word);

// The same for a value of a setting: "did you mean `sun`?".
std::string hintOnValue(const Setting& setting, std::string_view word);

// Where to find what others call so and no setting is: "materials are the model's". Empty if
// unknown.
std::string_view placeOf(std::string_view word);

}  // namespace chromeball

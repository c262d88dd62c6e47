// SPDX-License-Identifier: Apache-2.0
// The reference page of the scene file.
#pragma once

#include <string>

#include "front/setting.h"

namespace chromeball {

// docs/scene-file.md, from the table of settings: every key with its type, range, unit, default,
// option and meaning.
std::string settingsPage();

// The default in words: "256", "the model's first camera", "off".
std::string defaultText(const Setting& setting);

}  // namespace chromeball

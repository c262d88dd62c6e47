// SPDX-License-Identifier: Apache-2.0
// The parts of the table of settings.
#pragma once

#include "front/setting_table.h"

namespace chromeball {

std::vector<Setting> sceneRows();      // [[model]], [camera], [probe], [lighting]
std::vector<Setting> lightRows();      // [[light]]
std::vector<Setting> sourceRows();     // [[source]]
std::vector<Setting> renderRows();     // [render], [output]
std::vector<Setting> compositeRows();  // [composite], [surroundings]
std::vector<Setting> commandRows();    // options without a key

inline constexpr Range kPositive{.min = 0, .excludesMin = true};
inline constexpr Range kNotNegative{.min = 0};
inline constexpr Range kSunAngle{.min = 0.01, .max = 90};

}  // namespace chromeball

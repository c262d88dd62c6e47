// SPDX-License-Identifier: Apache-2.0
// Values of the library as JSON, for --json.
#pragma once

#include "base/json.h"

namespace chromeball {

template <class Vector>
requires requires(const Vector& v) { v.x, v.y, v.z; }
nlohmann::ordered_json vectorToJson(const Vector& v) { return {v.x, v.y, v.z}; }

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Values of the library as JSON, for --json.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/json.h"

namespace chromeball {

using JsonValue = nlohmann::ordered_json;

template <class Vector>
requires requires(const Vector& v) { v.x, v.y, v.z; }
JsonValue vectorToJson(const Vector& v) { return {v.x, v.y, v.z}; }

// JSON has no infinity or NaN: null.
inline JsonValue orNull(double number) {
  return std::isfinite(number) ? JsonValue(number) : JsonValue();
}
inline JsonValue orNull(const std::optional<double>& number) {
  return number ? JsonValue(*number) : JsonValue();
}

inline void printJson(const JsonValue& json) { fmt::print("{}\n", jsonText(json, 2)); }

}  // namespace chromeball

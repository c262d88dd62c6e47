// SPDX-License-Identifier: Apache-2.0
// JSON as text, and from text that may be damaged.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace chromeball {

// On one line if `indent` is negative. Names of files may hold any byte: what is not UTF-8 becomes
// U+FFFD.
std::string jsonText(const nlohmann::ordered_json& json, int indent = -1);

// A `discarded` value if the text is no JSON, or nested more deeply than what this program writes.
nlohmann::ordered_json readJson(const std::string& text);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// JSON in tests: its parser and its writer, which GoogleTest calls, are compiled once.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

namespace chromeball {

// These throw nlohmann::json::parse_error.
nlohmann::json parseJson(const std::string& text);
nlohmann::json jsonOfFile(const std::string& path);

}  // namespace chromeball

// GoogleTest finds them by these names.
NLOHMANN_JSON_NAMESPACE_BEGIN
void PrintTo(const json& value, std::ostream* out);
void PrintTo(const ordered_json& value, std::ostream* out);
NLOHMANN_JSON_NAMESPACE_END

// SPDX-License-Identifier: Apache-2.0
#include "json_file.h"

#include "base/json.h"
#include "run_command.h"

namespace chromeball {

nlohmann::json parseJson(const std::string& text) {
  return parseJson({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

nlohmann::json jsonOfFile(const std::string& path) { return parseJson(fileContents(path)); }

}  // namespace chromeball

NLOHMANN_JSON_NAMESPACE_BEGIN
void PrintTo(const json& value, std::ostream* out) { *out << chromeball::jsonText(value); }
void PrintTo(const ordered_json& value, std::ostream* out) { *out << chromeball::jsonText(value); }
NLOHMANN_JSON_NAMESPACE_END

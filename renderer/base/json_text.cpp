// SPDX-License-Identifier: Apache-2.0
#include "base/json_text.h"

#include "base/json.h"

namespace chromeball {

using Json = nlohmann::ordered_json;

std::string jsonText(const nlohmann::json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string jsonText(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

nlohmann::json parseJson(std::span<const uint8_t> text) {
  return nlohmann::json::parse(text.begin(), text.end());
}

Json readJson(const std::string& text) {
  constexpr int kDeepest = 32;  // writing it again is recursive
  bool isTooDeep = false;
  const Json value = Json::parse(
      text,
      [&](int depth, Json::parse_event_t, const Json&) {
        isTooDeep |= depth > kDeepest;
        return !isTooDeep;
      },
      false);
  return isTooDeep ? Json(Json::value_t::discarded) : value;
}

}  // namespace chromeball

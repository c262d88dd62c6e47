// SPDX-License-Identifier: Apache-2.0
#include "job/json_text.h"

#include <nlohmann/json.hpp>

namespace chromeball {

using Json = nlohmann::ordered_json;

std::string jsonText(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json readJson(const std::string& text) {
  constexpr int kDeepest = 32;  // writing it again is recursive
  bool isTooDeep = false;
  const Json json = Json::parse(
      text,
      [&](int depth, Json::parse_event_t, const Json&) {
        isTooDeep |= depth > kDeepest;
        return !isTooDeep;
      },
      false);
  return isTooDeep ? Json(Json::value_t::discarded) : json;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/json.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/file.h"

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

namespace {

template <class AnyJson>
AnyJson parsed(const std::string& text, size_t mostKeys) {
  constexpr int kDeepest = 32;  // writing it again is recursive
  size_t keys = 0;
  bool isTooMuch = false;
  const AnyJson value = AnyJson::parse(
      text,
      [&](int depth, typename AnyJson::parse_event_t event, const AnyJson&) {
        keys += event == AnyJson::parse_event_t::key;
        isTooMuch |= depth > kDeepest || keys > mostKeys;
        return !isTooMuch;
      },
      false);
  return isTooMuch ? AnyJson(AnyJson::value_t::discarded) : value;
}

}  // namespace

nlohmann::json readJson(const std::string& text) {
  return parsed<nlohmann::json>(text, std::numeric_limits<size_t>::max());
}

Json readOrderedJson(const std::string& text) {
  constexpr size_t kMostKeys = 20'000;  // each is searched among those before it
  return parsed<Json>(text, kMostKeys);
}

using nlohmann::json;

json readJsonFile(const std::filesystem::path& path, size_t maxMegabytes, std::string_view kind) {
  std::error_code unreadable;
  const auto size = std::filesystem::file_size(path, unreadable);
  if (!unreadable && size > maxMegabytes << 20)
    throwInput("{}: has {} MB; {} have at most {}", path.string(), size >> 20, kind, maxMegabytes);
  const std::vector<uint8_t> bytes = readFile(path);
  try {
    return parseJson(bytes);
  } catch (const json::parse_error& error) {
    const auto end = bytes.begin() + ptrdiff_t(std::min(error.byte, bytes.size()));
    throwInput("{}:{}: is not valid JSON here", path.string(),
               1 + std::count(bytes.begin(), end, '\n'));
  } catch (const json::out_of_range&) {  // which the parser throws for nothing else
    throwInput("{}: has a number beyond 1.8e308, the range of a double", path.string());
  }
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// nlohmann/json.hpp without its literals, and JSON as text. The literal for JSON is an inline
// function, for which each file that includes the header would instantiate the parser: half a
// second, in a hundred groups of files.
#pragma once

#define JSON_USE_GLOBAL_UDLS 0
// Turns `inline json operator "" _json(...) {...}` into a declaration and a template.
#define _json                                \
  _json_undefined(const char*, std::size_t); \
  template <class>                           \
  nlohmann::json literal
#include <nlohmann/json.hpp>
#undef _json

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace chromeball {

// Writes JSON as text, and reads it from text that may be damaged. The writer and the parser take a
// second to compile: call these.

// The text of a JSON value, on one line if `indent` is negative. Names of files may hold any byte:
// what is not UTF-8 becomes U+FFFD.
std::string jsonText(const nlohmann::json& json, int indent = -1);
std::string jsonText(const nlohmann::ordered_json& json, int indent = -1);

// Throws nlohmann::json::exception: parse_error, or out_of_range for a number beyond a double's.
nlohmann::json parseJson(std::span<const uint8_t> text);

// A `discarded` value if the text is no JSON, or nested more deeply than this program writes it.
nlohmann::json readJson(const std::string& text);
// The same with the order of its members, and also `discarded` for more than 20,000 of them.
nlohmann::ordered_json readOrderedJson(const std::string& text);

// Reads JSON files that people write.

// `kind`: what the file should be, in the plural: "lists of lights". Throws InputError for a file
// of more than maxMegabytes, and, with the line, for one that is not JSON.
nlohmann::json readJsonFile(const std::filesystem::path& path, size_t maxMegabytes,
                            std::string_view kind);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// nlohmann/json.hpp without its literals. The literal for JSON is an inline function, for which
// each file that includes the header would instantiate the parser: half a second, in a hundred
// groups of files.
#pragma once

#define JSON_USE_GLOBAL_UDLS 0
// Turns `inline json operator "" _json(...) {...}` into a declaration and a template.
#define _json                                \
  _json_undefined(const char*, std::size_t); \
  template <class>                           \
  nlohmann::json literal
#include <nlohmann/json.hpp>
#undef _json

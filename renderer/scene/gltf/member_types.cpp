// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/member_types.h"

#include <fmt/format.h>

#include <climits>
#include <cmath>
#include <stdexcept>

#include "base/json.h"
#include "base/json_text.h"
#include "base/printable.h"
#include "scene/gltf/object_types.h"

namespace chromeball {
namespace {

using nlohmann::json;

// Where a value is in the file: a member or an element of its parent.
struct JsonPlace {
  const JsonPlace* parent = nullptr;  // null: the file itself
  std::string_view member = {};       // empty: an element of an array
  size_t element = 0;

  std::string text() const {
    if (!parent) return "";
    const std::string before = parent->text();
    if (member.empty()) return fmt::format("{}[{}]", before, element);
    return fmt::format("{}{}{}", before, before.empty() ? "" : ".", printableName(member));
  }
};

// tinygltf keeps an `integer` as int and a `size` as size_t; doubles are whole up to 2^53.
constexpr uint64_t kMaxInteger = INT_MAX, kMaxSize = uint64_t(1) << 53;

bool isWhole(const json& value, uint64_t max) {
  return value.is_number_unsigned() && value.get<uint64_t>() <= max;
}

// A whole number may be written as 1.0 or 1e0 (glTF 2.0, "JSON Encoding"), which tinygltf ignores.
void writeAsInteger(json& value) {
  if (!value.is_number_float()) return;
  const double number = value.get<double>();
  if (number >= 0 && number <= double(kMaxSize) && number == std::floor(number))
    value = uint64_t(number);
}

bool isScalar(std::string_view type, const json& value) {
  if (type == "integer") return isWhole(value, kMaxInteger);
  if (type == "size") return isWhole(value, kMaxSize);
  if (type == "number") return value.is_number();
  if (type == "boolean") return value.is_boolean();
  return value.is_string();
}

std::string describeType(std::string_view type) {
  if (type.ends_with("[]")) return "an array";
  if (type == "integer") return fmt::format("a whole number from 0 to {}", kMaxInteger);
  if (type == "size") return fmt::format("a whole number from 0 to {}", kMaxSize);
  if (type == "number") return "a number";
  if (type == "boolean") return "true or false";
  if (type == "string") return "a string";
  return "an object";
}

std::string describeValue(const json& value) {
  if (value.is_string()) return "a string";
  if (value.is_array()) return "an array";
  if (value.is_object()) return "an object";
  return jsonText(value);
}

void require(bool matches, const json& value, std::string_view type, const JsonPlace& place) {
  if (!matches)
    throw std::runtime_error(fmt::format("{}: must be {}, not {}", place.text(), describeType(type),
                                         describeValue(value)));
}

void checkObject(json& value, const ObjectType& object, const JsonPlace& place);

void checkType(json& value, std::string_view type, const JsonPlace& place) {
  if (type.ends_with("[]")) {
    require(value.is_array(), value, type, place);
    type.remove_suffix(2);
    for (size_t i = 0; i < value.size(); ++i) checkType(value[i], type, {&place, {}, i});
  } else if (type.ends_with("{}")) {
    require(value.is_object(), value, type, place);
    type.remove_suffix(2);
    for (const auto& [name, member] : value.items()) checkType(member, type, {&place, name});
  } else if (const ObjectType* object = findObjectType(type)) {
    checkObject(value, *object, place);
  } else {
    if (type == "integer" || type == "size") writeAsInteger(value);
    require(isScalar(type, value), value, type, place);
  }
}

void checkExtensionTypes(json& extensions, const JsonPlace& place) {
  require(extensions.is_object(), extensions, "object", place);
  const auto kindOf = [](std::string_view name) {
    return name == "KHR_meshopt_compression" ? "EXT_meshopt_compression"
                                             : name;  // the same members
  };
  for (const auto& [name, extension] : extensions.items())
    if (const ObjectType* object = findObjectType(kindOf(name)))
      checkObject(extension, *object, {&place, name});
}

void checkObject(json& value, const ObjectType& object, const JsonPlace& place) {
  require(value.is_object(), value, object.kind, place);
  for (const auto& [name, element] : value.items())
    if (name == "extensions")
      checkExtensionTypes(element, {&place, name});
    else if (const MemberType* member = findMemberType(object, name))
      checkType(element, member->type, {&place, name});
}

}  // namespace

void checkMemberTypes(json& root) { checkType(root, "File", {}); }

}  // namespace chromeball

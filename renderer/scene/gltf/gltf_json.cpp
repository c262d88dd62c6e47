// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <stdexcept>

#include "base/json.h"
#include "base/text.h"

namespace chromeball {
namespace {

using nlohmann::json;

// How the user can avoid an unsupported extension.
const char* adviceFor(const std::string& extension) {
  if (extension == "KHR_texture_basisu")
    return "convert its KTX2 textures to PNG, JPEG or WebP (`ktx extract` of KTX-Software can)";
  if (extension == "EXT_texture_avif" || extension == "MSFT_texture_dds")
    return "export it again with PNG, JPEG or WebP textures";
  return "export it again without it";
}

std::set<std::string> namesIn(const json& root, const char* key) {
  std::set<std::string> names;
  if (const auto list = root.find(key); list != root.end())
    for (const json& name : *list) names.insert(name.get<std::string>());
  return names;
}

bool exceedsInt(const json& value) {
  if (value.is_number_unsigned()) return value.get<uint64_t>() > uint64_t(INT_MAX);
  return value.is_number_integer() && value.get<int64_t>() < INT_MIN;
}

}  // namespace

bool isSupportedExtension(std::string_view extension) {
  return extension == "KHR_mesh_quantization" ||
         ((extension.starts_with("EXT_") || extension.starts_with("KHR_")) &&
          findObjectType(extension));
}

void checkVersion(const json& root) {
  const auto asset = root.find("asset");
  const std::string version = asset == root.end() ? "" : stringMember(*asset, "version");
  if (version.starts_with("1") || version.empty())
    throw std::runtime_error(version.empty()
                                 ? "has no asset.version; it must be \"2.0\""
                                 : "is glTF 1.0; convert it to glTF 2.0 (gltf-pipeline can)");
  const std::string minimum = stringMember(*asset, "minVersion");
  if (!version.starts_with("2.") || (!minimum.empty() && minimum != "2.0"))
    throw std::runtime_error(fmt::format("requires glTF {}; only 2.0 is supported",
                                         minimum.empty() ? version : minimum));
}

std::set<std::string> checkExtensions(const json& root) {
  for (const std::string& name : namesIn(root, "extensionsRequired"))
    if (!isSupportedExtension(name))
      throw std::runtime_error(fmt::format("requires the extension {}, which is not supported; {}",
                                           printableName(name), adviceFor(name)));
  std::set<std::string> ignored = namesIn(root, "extensionsUsed");
  std::erase_if(ignored, isSupportedExtension);
  return ignored;
}

void requireJoints(const json& root) {
  const auto skins = root.find("skins");
  if (skins == root.end()) return;
  for (size_t i = 0; i < skins->size(); ++i)
    if (!(*skins)[i].contains("joints"))
      throw std::runtime_error(fmt::format("skins[{}].joints: is missing", i));
}

int fillGaps(json& root) {
  for (json& skin : root["skins"])
    if (!skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
  for (json& animation : root["animations"])
    if (animation.contains("channels"))
      for (json& channel : animation["channels"])
        if (channel.contains("target") && !channel["target"].contains("node"))
          channel["target"]["node"] = -1;
  json& views = root["bufferViews"];
  const int none = int(views.size());
  json& accessors = root["accessors"];
  for (size_t i = 0; i < accessors.size(); ++i) {
    json& view = accessors[i]["bufferView"];  // null: has none
    if (view.is_number() && view.get<double>() == none)
      throw std::runtime_error(
          fmt::format("accessors[{}].bufferView: bufferViews[{}] does not exist ({} in the file)",
                      i, none, none));
    if (view.is_null()) view = none;
  }
  views.push_back({{"buffer", 0}, {"byteLength", 1}});
  return none;
}

void keepLargeNumbers(json& value, bool inExtension) {
  if (inExtension && exceedsInt(value)) value = value.get<double>();
  if (value.is_array())
    for (json& element : value) keepLargeNumbers(element, inExtension);
  if (value.is_object())
    for (auto& [key, member] : value.items())
      keepLargeNumbers(member, inExtension || key == "extensions" || key == "extras");
}

json takeArray(json& root, const char* key) {
  const auto found = root.find(key);
  json array = found != root.end() && found->is_array() ? std::move(*found) : json::array();
  root.erase(key);
  return array;
}

uint64_t unsignedMember(const json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned())
    throw std::runtime_error(fmt::format("{}.{} is missing or not a whole number", where, key));
  return found->get<uint64_t>();
}

std::string stringMember(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

namespace {

// The place of a value in the file: a member or an element of its parent.
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
  for (const auto& [name, extension] : extensions.items())
    if (const ObjectType* object = findObjectType(name))
      checkObject(extension, *object, {&place, name});
}

void checkObject(json& value, const ObjectType& object, const JsonPlace& place) {
  require(value.is_object(), value, object.kind, place);
  for (const auto& [name, element] : value.items())
    if (name == "extensions")
      checkExtensionTypes(element, {&place, name});
    else if (const std::string_view type = memberTypeOf(object, name); !type.empty())
      checkType(element, type, {&place, name});
}

}  // namespace

void checkMemberTypes(json& root) { checkType(root, "File", {}); }

const tinygltf::Value& memberOf(const tinygltf::Value& object, const std::string& key) {
  static const tinygltf::Value none;
  return object.IsObject() ? object.Get(key) : none;
}

const tinygltf::Value& elementOf(const tinygltf::Value& array, size_t index) {
  static const tinygltf::Value none;
  return index < array.ArrayLen() ? array.Get(int(index)) : none;
}

int intMember(const tinygltf::Value& object, const std::string& key, int fallback) {
  const tinygltf::Value& v = memberOf(object, key);
  return v.IsInt() ? v.GetNumberAsInt() : fallback;
}

std::string textMember(const tinygltf::Value& object, const char* key, const char* fallback) {
  const tinygltf::Value& v = memberOf(object, key);
  return v.IsString() ? v.Get<std::string>() : fallback;
}

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

float number(GltfFile& file, double x, double low, double high, const std::string& where) {
  if (!std::isfinite(x)) file.fail("{}: is not a finite number", where);
  if (x < low || x > high)
    file.warnOnce(fmt::format("{}: {} is clamped to the range {} to {}", where, x, low, high));
  return float(std::clamp(x, low, high));
}

float member(GltfFile& file, const tinygltf::Value& object, const char* key, double fallback,
             double low, double high, const std::string& where) {
  const tinygltf::Value& v = memberOf(object, key);
  return number(file, v.IsNumber() ? v.GetNumberAsDouble() : fallback, low, high,
                where + "." + key);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/extension_members.h"

#include <fmt/format.h>

#include <algorithm>

namespace chromeball {

const tinygltf::Value& memberOf(const tinygltf::Value& object, const std::string& key) {
  static const tinygltf::Value none;
  return object.IsObject() ? object.Get(key) : none;
}

const tinygltf::Value& elementOf(const tinygltf::Value& array, size_t index) {
  static const tinygltf::Value none;
  return index < array.ArrayLen() ? array.Get(int(index)) : none;
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

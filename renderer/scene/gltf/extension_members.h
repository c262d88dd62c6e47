// SPDX-License-Identifier: Apache-2.0
// Members of a glTF extension's JSON, checked.
#pragma once

#include <string>

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// The extension's object; null where the file does not use it here.
const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name);

// A number of the file, clamped to the range the specification gives it.
float number(GltfFile& file, double x, double low, double high, const std::string& where);

// A member of an object, or `fallback` where it is missing.
float member(GltfFile& file, const tinygltf::Value& object, const char* key, double fallback,
             double low, double high, const std::string& where);

template <int N>
glm::vec<N, float> vectorMember(GltfFile& file, const tinygltf::Value& object, const char* key,
                                glm::vec<N, float> fallback, double low, double high,
                                const std::string& where) {
  const tinygltf::Value& v = object.Get(key);
  if (!v.IsArray()) return fallback;
  if (v.ArrayLen() != N) file.fail("{}.{}: has {} numbers, not {}", where, key, v.ArrayLen(), N);
  for (int i = 0; i < N; ++i) {
    if (!v.Get(i).IsNumber()) file.fail("{}.{}: holds something that is no number", where, key);
    fallback[i] = number(file, v.Get(i).GetNumberAsDouble(), low, high, where + "." + key);
  }
  return fallback;
}

}  // namespace chromeball

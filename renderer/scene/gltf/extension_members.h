// SPDX-License-Identifier: Apache-2.0
// Reads members of a glTF extension's JSON with checks.
#pragma once

#include <string>

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// A member of an object and an element of an array; a null value if there is none. (tinygltf's
// Get() aborts unless the value is an object or array. It drops empty ones, so that a file's {} and
// [] are null too.)
const tinygltf::Value& memberOf(const tinygltf::Value& object, const std::string& key);
const tinygltf::Value& elementOf(const tinygltf::Value& array, size_t index);

// The extension's object; null if it is absent or not an object.
const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name);

// Clamps a number to the range that the specification allows, with a warning. Throws InputError if
// it is not finite.
float number(GltfFile& file, double x, double low, double high, const std::string& where);

// A member of an object, or `fallback` if it is missing; clamped as by number().
float member(GltfFile& file, const tinygltf::Value& object, const char* key, double fallback,
             double low, double high, const std::string& where);

template <int N>
glm::vec<N, float> vectorMember(GltfFile& file, const tinygltf::Value& object, const char* key,
                                glm::vec<N, float> fallback, double low, double high,
                                const std::string& where) {
  const tinygltf::Value& v = memberOf(object, key);
  if (!v.IsArray()) return fallback;
  if (v.ArrayLen() != N)
    file.fail("{}.{}: has {} numbers; it must have {}", where, key, v.ArrayLen(), N);
  for (int i = 0; i < N; ++i) {
    if (!elementOf(v, size_t(i)).IsNumber())
      file.fail("{}.{}: element {} is not a number", where, key, i);
    fallback[i] =
        number(file, elementOf(v, size_t(i)).GetNumberAsDouble(), low, high, where + "." + key);
  }
  return fallback;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Checks and repairs a glTF file's JSON before tinygltf reads it; for the types of its members see
// below.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <set>
#include <string>
#include <string_view>

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// These functions throw std::runtime_error with a reason to be preceded by the name of the file.

// Throws unless the file is glTF 2.0.
void checkVersion(const nlohmann::json& root);

bool isSupportedExtension(std::string_view name);

// Throws for an extension that the file requires and that is not supported, with advice. Returns
// the extensions that it uses but that are ignored.
std::set<std::string> checkExtensions(const nlohmann::json& root);

// Throws for skins without joints, which tinygltf rejects without giving a reason.
void requireJoints(const nlohmann::json& root);

// tinygltf rejects three things that the specification allows: a skin without inverse bind
// matrices, an animation channel without a node (an extension may define its target), and indices
// whose accessor has no buffer view. The first two get the index -1, tinygltf's "none". Accessors
// without a buffer view get an additional dummy view, whose index is returned.
int fillGaps(nlohmann::json& root);

// tinygltf reads whole numbers in extensions and extras as int. Those that exceed its range become
// floating-point numbers.
void keepLargeNumbers(nlohmann::json& value, bool inExtension = false);

// Removes an array from the file and returns it; empty if there is none.
nlohmann::json takeArray(nlohmann::json& root, const char* key);

// Throws unless the object has such a member.
uint64_t unsignedMember(const nlohmann::json& object, const char* key, const std::string& where);

// Empty if the object has no such string.
std::string stringMember(const nlohmann::json& object, const char* key);

// The types that glTF 2.0 and its extensions give to the members that we read.

// tinygltf takes the default for an optional member whose type differs from the specification's,
// and the low bits of a whole number beyond int. Throws std::runtime_error, a reason to be preceded
// by the name of the file, for the first such member: "nodes[3].mesh: must be a whole number from 0
// to 2147483647, not a string". Members that are not read are not looked at. Whole numbers that are
// written as 1.0 or 1e0, which are valid, become 1.
void checkMemberTypes(nlohmann::json& root);

// Reads members of a glTF extension's JSON with checks.

// A member of an object and an element of an array; a null value if there is none. (tinygltf's
// Get() aborts unless the value is an object or array. It drops empty ones, so that a file's {} and
// [] are null too.)
const tinygltf::Value& memberOf(const tinygltf::Value& object, const std::string& key);
const tinygltf::Value& elementOf(const tinygltf::Value& array, size_t index);

// A member that is a whole number, or a string; `fallback` if there is none.
int intMember(const tinygltf::Value& object, const std::string& key, int fallback = -1);
std::string textMember(const tinygltf::Value& object, const char* key, const char* fallback = "");

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

// The kinds of objects in glTF 2.0 and its extensions, and the types of the members that we read.

// The members are written "name:type name:type". A type is a kind of object; `integer`, `size`,
// `number`, `boolean` or `string`; `T[]`, an array of T; or `T{}`, an object with any members of
// type T. An `integer` is an int, a `size` a size_t of tinygltf. Extensions are kinds too: those
// that have a row here are supported.
struct ObjectType {
  std::string_view kind, members;
};

// Null if there is none.
const ObjectType* findObjectType(std::string_view kind);
// The type of a member; empty if it is none that we read.
std::string_view memberTypeOf(const ObjectType& object, std::string_view name);

}  // namespace chromeball

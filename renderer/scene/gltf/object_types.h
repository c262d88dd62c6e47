// SPDX-License-Identifier: Apache-2.0
// The kinds of objects in glTF 2.0 and its extensions, and the types of the members that we read.
#pragma once

#include <string_view>

namespace chromeball {

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

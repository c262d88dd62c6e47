// SPDX-License-Identifier: Apache-2.0
// The kinds of objects in glTF 2.0 and its extensions, and the types of the members that we read.
#pragma once

#include <string_view>

namespace chromeball {

// A kind of object; `integer`, `size`, `number`, `boolean` or `string`; `T[]`, an array of T; or
// `T{}`, an object with any members of type T. An `integer` is an int, a `size` a size_t of
// tinygltf.
struct MemberType {
  std::string_view name, type;
};
struct ObjectType {
  static constexpr size_t kMostMembers = 17;
  std::string_view kind;
  MemberType members[kMostMembers];
};

// Null if there is none.
const ObjectType* findObjectType(std::string_view kind);
const MemberType* findMemberType(const ObjectType& object, std::string_view name);

}  // namespace chromeball

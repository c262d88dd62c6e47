// SPDX-License-Identifier: Apache-2.0
// The types that glTF 2.0 and its extensions give to the members that we read.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace chromeball {

// tinygltf takes the default for an optional member of another type than the specification's, and
// the low bits of a whole number beyond int. Throws std::runtime_error, a reason to be preceded by
// the name of the file, for the first such member: "nodes[3].mesh: must be a whole number from 0 to
// 2147483647, not a string". Members that are not read are not looked at. Whole numbers that are
// written as 1.0 or 1e0, which are valid, become 1.
void checkMemberTypes(nlohmann::json& root);

}  // namespace chromeball

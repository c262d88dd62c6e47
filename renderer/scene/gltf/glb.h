// SPDX-License-Identifier: Apache-2.0
// The container and the JSON of a glTF file (.glb or .gltf), before its contents are interpreted.
// Both functions throw std::runtime_error with a reason to be preceded by the file's name ("is a
// truncated GLB").
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

namespace chromeball {

struct GltfChunks {
  std::span<const uint8_t> json, binary;
};

// Splits a .glb into its chunks. A file that does not start with the GLB magic is all JSON.
GltfChunks splitContainer(std::span<const uint8_t> file);

// Parses a JSON object. Throws if it nests deeper than 128 levels, since its users recurse. Numbers
// without a fractional part become integers, however they are written.
nlohmann::json parseRoot(std::span<const uint8_t> text);

}  // namespace chromeball

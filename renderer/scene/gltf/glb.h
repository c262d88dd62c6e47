// SPDX-License-Identifier: Apache-2.0
// The container and the JSON of a glTF file (.glb or .gltf), before its contents are interpreted.
// Both functions throw std::runtime_error with a reason to be preceded by the file's name ("is a
// truncated GLB").
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

struct GltfChunks {
  std::span<const uint8_t> json, binary;
};

// Splits a .glb into its chunks. A file that does not start with the GLB magic is all JSON.
GltfChunks splitContainer(std::span<const uint8_t> file);

// Parses a JSON object. Throws if it nests deeper than 128 levels, since its users recurse. Numbers
// without a fractional part become integers, however they are written.
nlohmann::json parseRoot(std::span<const uint8_t> text);

// The URIs of a glTF file: data URIs, and relative paths of other files.

// Whether a URI has the scheme data:, in capitals or not (RFC 3986, 3.1).
bool isDataUri(std::string_view uri);

// Decodes a data URI (RFC 2397), in base64 or percent-encoded. Returns false if it is invalid.
bool decodeDataUri(const std::string& uri, std::vector<uint8_t>& bytes);

// Replaces each %XX by the byte with that hexadecimal code.
std::string decodePercent(const std::string& uri);

// These throw std::runtime_error with a reason to be preceded by the name ("is an absolute path").

// Throws if a URI, still encoded, has a scheme (RFC 3986).
void checkNoScheme(const std::string& uri);

// Throws if a decoded URI is empty or has a backslash or a control character.
void checkFileName(const std::string& name);

// Throws if `folder / name` is outside of the folder: by an absolute path, by "..", or through a
// link.
void checkInside(const std::filesystem::path& folder, const std::string& name);

}  // namespace chromeball

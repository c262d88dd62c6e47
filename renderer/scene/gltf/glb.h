// SPDX-License-Identifier: Apache-2.0
// The bytes of a glTF file and the files it names, before any of them is interpreted.
// Everything here throws std::runtime_error with a reason that lacks the file's name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

std::vector<uint8_t> readWholeFile(const std::filesystem::path& path);

struct GltfChunks {
  std::span<const uint8_t> json, binary;
};

// Splits a .glb into its chunks; whatever does not begin with the GLB magic is all JSON.
GltfChunks splitContainer(std::span<const uint8_t> file);

// Parses an object that nests at most 128 levels (everyone downstream recurses). Numbers without a
// fractional part come out as integers, however they are written.
nlohmann::json parseJson(std::span<const uint8_t> text);

// The bytes of a data URI, in base64 or percent-encoded. False where it is not well-formed.
bool decodeDataUri(const std::string& uri, std::vector<uint8_t>& bytes);

// Replaces %XX by the byte it stands for.
std::string decodePercent(const std::string& uri);

// Throws where a decoded URI has a scheme, or characters that no file should have in its name.
void checkFileName(const std::string& name);

// Throws where `folder / name` is not below the folder: by an absolute path, by "..", or because a
// link leads out.
void checkInside(const std::filesystem::path& folder, const std::string& name);

}  // namespace chromeball

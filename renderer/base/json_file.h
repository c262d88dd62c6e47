// SPDX-License-Identifier: Apache-2.0
// Reads JSON files that people write.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace chromeball {

// `kind`: what the file should be, in the plural: "lists of lights". Throws InputError for a file
// of more than maxMegabytes, and, with the line, for one that is not JSON.
nlohmann::json readJsonFile(const std::filesystem::path& path, size_t maxMegabytes,
                            std::string_view kind);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Real probes and models, stored outside of the source tree; tests skip if they are absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "paths.h"

// A path in the folder $CHROMEBALL_DATA or, if that is not set, ../shared/data relative to the
// source tree; nullopt if it does not exist.
inline std::optional<std::filesystem::path> sharedData(const std::string& relative) {
  const char* folder = std::getenv("CHROMEBALL_DATA");
  const std::filesystem::path root =
      folder ? folder : std::filesystem::path(kSourceDir).parent_path() / "shared/data";
  const std::filesystem::path path = root / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

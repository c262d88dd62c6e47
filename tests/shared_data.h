// SPDX-License-Identifier: Apache-2.0
// Real probes and models that live beside the project, where they are present.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "paths.h"

// The folder is $CHROMEBALL_DATA, or ../shared/data beside the source tree. Tests that get nullopt
// skip, and say so.
inline std::optional<std::filesystem::path> sharedData(const std::string& relative) {
  const char* folder = std::getenv("CHROMEBALL_DATA");
  const std::filesystem::path root =
      folder ? folder : std::filesystem::path(kSourceDir).parent_path() / "shared/data";
  const std::filesystem::path path = root / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

// SPDX-License-Identifier: Apache-2.0
#include "shared_data.h"

#include <cstdlib>

#include "paths.h"

std::optional<std::filesystem::path> sharedData(const std::string& relative) {
  const char* folder = std::getenv("CHROMEBALL_DATA");
  const std::filesystem::path root =
      folder ? folder : std::filesystem::path(kSourceDir).parent_path() / "shared/data";
  const std::filesystem::path path = root / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

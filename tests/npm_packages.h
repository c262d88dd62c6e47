// SPDX-License-Identifier: Apache-2.0
// The packages of tests/npm, if tools/scripts/test_needs.sh has installed them.
#pragma once

#include <filesystem>
#include <string>

#include "paths.h"

constexpr const char* kNoNpmPackages = "no build/npm; see tools/scripts/test_needs.sh";

// Links them into `folder`, where programs of Node.js and pages find them; false if there are none.
inline bool linkNpmPackages(const std::string& folder) {
  const std::string packages = std::string(kSourceDir) + "/build/npm/node_modules";
  if (!std::filesystem::exists(packages)) return false;
  std::filesystem::create_directory_symlink(packages, folder + "/node_modules");
  return true;
}

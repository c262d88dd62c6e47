// SPDX-License-Identifier: Apache-2.0
#include "npm_packages.h"

#include <filesystem>

#include "paths.h"

bool linkNpmPackages(const std::string& folder) {
  const std::string packages = std::string(kSourceDir) + "/build/npm/node_modules";
  if (!std::filesystem::exists(packages)) return false;
  std::filesystem::create_directory_symlink(packages, folder + "/node_modules");
  return true;
}

// SPDX-License-Identifier: Apache-2.0
// Excludes other processes from a file.
#pragma once

#include <filesystem>

namespace chromeball {

// Holds FILE.lock until it is destroyed. The system releases it also if the process is killed.
class FileLock {
 public:
  // Throws InputError if another process holds it, RunError if it cannot be created.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace chromeball

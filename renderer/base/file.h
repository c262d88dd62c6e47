// SPDX-License-Identifier: Apache-2.0
// Whole files: read with the errors of this project, written so that nobody sees half of one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace chromeball {

// Throws InputError where the path is no readable regular file (a pipe or device would never end).
void checkReadable(const std::filesystem::path& path);

// All bytes of a regular file. Throws InputError.
std::vector<uint8_t> readFile(const std::filesystem::path& path);

// Asked before the work whose result is to stand there, since only a write that fails is sure.
// Throws InputError where there is no such folder, RunError where no file can be created or
// replaced in it.
void checkReplaceable(const std::filesystem::path& path);

// A file that appears under its name only when complete: written under a temporary name in the same
// folder, renamed by commit(), removed where commit() was not reached.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }  // write here
  void commit();                                                         // throws RunError

 private:
  std::filesystem::path target_, temporary_;
};

// Writes the bytes atomically. Throws RunError.
void writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

}  // namespace chromeball

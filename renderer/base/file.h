// SPDX-License-Identifier: Apache-2.0
// Reads and writes whole files. Writes are atomic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

// Throws InputError unless the path is a readable regular file (a pipe or device might never end).
void checkReadable(const std::filesystem::path& path);

// ".exr" of "A.EXR": a file's extension in lower case; empty if it has none.
std::string lowerExtension(const std::filesystem::path& path);

// All bytes of a regular file. Throws InputError.
std::vector<uint8_t> readFile(const std::filesystem::path& path);

// The same for long files: by several threads, into memory that is not cleared before.
class FileBytes {
 public:
  FileBytes() = default;
  explicit FileBytes(const std::filesystem::path& path);

  std::span<const uint8_t> bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<uint8_t[]> data_;
  size_t size_ = 0;
};

// Checks that a file can be created or replaced at `path`, so that a run fails before the work and
// not after it. The write itself may still fail. Throws InputError if the folder does not exist or
// `path` is no file that can be replaced (atomic_file.h), RunError if nothing can be written into
// it.
void checkReplaceable(const std::filesystem::path& path);

// Writes the bytes atomically. Throws RunError.
void writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

}  // namespace chromeball

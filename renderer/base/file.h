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

// A readable regular file, which several threads may read at once. Functions throw InputError.
class SharedFile {
 public:
  explicit SharedFile(const std::filesystem::path& path);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  std::string name() const { return path_.string(); }
  void read(uint64_t at, void* to, size_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

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
// `path` is no file that can be replaced, RunError if nothing can be written into it.
void checkReplaceable(const std::filesystem::path& path);

// Writes the bytes atomically. Throws RunError.
void writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

// A hash of a file's contents.

// A hash of a file's bytes. Throws InputError if it cannot be read.
uint64_t fingerprint(const std::string& path);

// A file that is either as it was before or complete.

// A file that appears under its name only when complete. It is written under a temporary name in
// the same folder and renamed by commit(). The destructor removes it if commit() was not called.
//
// The temporary name consists of the names of the file and of this machine. The file is locked, so
// that the next process that writes it on the same machine overwrites what a killed one left. The
// files of other machines are never touched: whether their process still exists is not known here.
//
// A symbolic link remains: the file that it points to is replaced.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);  // throws as replaceableFile() does
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }  // write here
  void commit();                                                         // throws RunError

 private:
  std::filesystem::path target_, temporary_;
  int lock_ = -1;  // descriptor of the temporary file; -1: none
};

// The file at the end of the symbolic links that begin at `path`; it need not exist. Throws
// InputError if it is a FIFO, a device or a socket, which cannot be replaced by a complete file, or
// if the links go in a circle.
std::filesystem::path replaceableFile(const std::filesystem::path& path);

// Excludes other processes from a file.

// Holds FILE.lock until it is destroyed. The system releases it also if the process is killed.
class FileLock {
 public:
  // Throws InputError if another process holds it, or if it has contents and is no lock; RunError
  // if it cannot be created.
  explicit FileLock(const std::filesystem::path& file);
  static std::filesystem::path nameOf(const std::filesystem::path& file) {
    return file.string() + ".lock";
  }
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace chromeball

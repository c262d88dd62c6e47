// SPDX-License-Identifier: Apache-2.0
// A file that is either as it was before or complete.
#pragma once

#include <filesystem>

namespace chromeball {

// A file that appears under its name only when complete. It is written under a temporary name in
// the same folder and renamed by commit(). The destructor removes it if commit() was not called.
//
// The temporary name is that of the file and of this machine, and locked, so that what a killed
// process left is overwritten by the next one that writes the file on the same machine. The files
// of other machines are never touched: whether their process still exists is not known here.
//
// A symbolic link stays one: the file that it leads to is replaced.
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

}  // namespace chromeball

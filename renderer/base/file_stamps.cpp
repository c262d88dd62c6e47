// SPDX-License-Identifier: Apache-2.0
#include "base/file_stamps.h"

#include <sys/stat.h>

#include <algorithm>
#include <system_error>

namespace chromeball {

// What cannot be known of a missing file has one value.
FileStamps::Stamp::Stamp(const std::string& file) {
  std::error_code ignored;
  path = std::filesystem::canonical(file, ignored);
  size = std::filesystem::file_size(file, ignored);
  written = std::filesystem::last_write_time(file, ignored);
  if (struct stat status{}; ::stat(file.c_str(), &status) == 0) {
    node = status.st_ino;
    changed = status.st_ctim.tv_sec, nanoseconds = status.st_ctim.tv_nsec;
  }
}

FileStamps::Time FileStamps::now() { return Time::clock::now(); }

void FileStamps::add(const std::vector<std::string>& files, Time begin) {
  const Time end = now();
  for (const std::string& file : files) {
    const Stamp stamp(file);
    const bool isWritten = stamp.written > begin && stamp.written <= end;
    stamps_[file] = isWritten ? std::nullopt : std::optional(stamp);
  }
}

bool FileStamps::isCurrent(const std::string& file) const {
  const auto found = stamps_.find(file);
  return found != stamps_.end() && found->second == Stamp(file);
}

bool FileStamps::areCurrent() const {
  return std::ranges::all_of(stamps_, [](const auto& s) { return s.second == Stamp(s.first); });
}

}  // namespace chromeball

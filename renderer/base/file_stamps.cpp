// SPDX-License-Identifier: Apache-2.0
#include "base/file_stamps.h"

#include <sys/stat.h>

#include <algorithm>

namespace chromeball {

FileStamps::Stamp FileStamps::stampOf(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino,
          std::chrono::seconds(status.st_ctim.tv_sec) + Time(status.st_ctim.tv_nsec)};
}

FileStamps::Time FileStamps::now() {
  return std::chrono::duration_cast<Time>(std::chrono::system_clock::now().time_since_epoch());
}

void FileStamps::add(const std::vector<std::string>& files, Time begin) {
  const Time end = now();
  for (const std::string& file : files) {
    const Stamp stamp = stampOf(file);
    const bool isWritten = stamp.changed > begin && stamp.changed <= end;
    stamps_[file] = isWritten ? std::nullopt : std::optional(stamp);
  }
}

bool FileStamps::isCurrent(const std::string& file) const {
  const auto found = stamps_.find(file);
  return found != stamps_.end() && found->second == stampOf(file);
}

bool FileStamps::areCurrent() const {
  return std::ranges::all_of(stamps_, [](const auto& s) { return s.second == stampOf(s.first); });
}

}  // namespace chromeball

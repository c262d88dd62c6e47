// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/long_array.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "base/work_monitor.h"

namespace chromeball {

namespace fs = std::filesystem;

namespace {

constexpr size_t kReadAtOnce = 8 << 20;  // bytes

// The system would take it for the file whose name ends there.
void refuseNul(const fs::path& path) {
  if (path.native().find('\0') != std::string::npos)
    throwInput("{}: the file name contains U+0000", path.string());
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  const int number_;
};

}  // namespace

void checkReadable(const fs::path& path) {
  refuseNul(path);
  const std::string name = printableName(path.string());
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throwInput("{}: no such file", name);
  // A loop of links, a name that is too long, or a folder that cannot be entered.
  if (error) throwInput("{}: {}", name, error.message());
  if (!fs::is_regular_file(status)) throwInput("{}: not a regular file", name);
  if (access(path.c_str(), R_OK) != 0) throwInput("{}: {}", name, std::strerror(errno));
}

std::string lowerExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::vector<uint8_t> readFile(const fs::path& path) {
  checkReadable(path);
  std::vector<uint8_t> bytes = longArray<uint8_t>(fs::file_size(path));
  std::ifstream in(path, std::ios::binary);
  forParts(bytes.size(), kReadAtOnce, [&](size_t begin, size_t end) {
    if (!in.read(reinterpret_cast<char*>(bytes.data() + begin), std::streamsize(end - begin)))
      throwInput("{}: cannot read the whole file", path.string());
  });
  return bytes;
}

FileBytes::FileBytes(const fs::path& path) {
  checkReadable(path);
  size_ = size_t(fs::file_size(path));
  data_.reset(new uint8_t[size_]);
  useLargePages(data_.get(), size_);
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  std::atomic<bool> isWhole = file >= 0;
  parallelFor(size_t(0), (size_ + kReadAtOnce - 1) / kReadAtOnce, [&](size_t block) {
    const size_t end = std::min(size_, (block + 1) * kReadAtOnce);
    for (size_t at = block * kReadAtOnce; at < end && isWhole;) {
      const ssize_t count = pread(file, data_.get() + at, end - at, off_t(at));
      if (count > 0) at += size_t(count);
      if (count == 0 || (count < 0 && errno != EINTR)) isWhole = false;
    }
  });
  if (!isWhole) throwInput("{}: cannot read the whole file", path.string());
}

void checkReplaceable(const fs::path& link) {
  refuseNul(link);
  const fs::path path = replaceableFile(link);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  const bool isFolder = fs::is_directory(folder, error);
  if (error && error != std::errc::no_such_file_or_directory)
    throwInput("{}: {}", path.string(), error.message());
  if (!isFolder) throwInput("{}: there is no folder {}", path.string(), folder.string());
  const bool isTaken = fs::is_directory(path, error);
  if (error && error != std::errc::no_such_file_or_directory)
    throwInput("{}: {}", path.string(), error.message());
  if (isTaken) throwInput("{}: cannot be written: it is a folder", path.string());
  if (access(folder.c_str(), W_OK) != 0)
    throwRun("{}: cannot write into {}: {}", path.string(), folder.string(), std::strerror(errno));
}

void writeFile(const fs::path& path, std::span<const uint8_t> bytes) {
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out.close();
  if (!out) throwRun("{}: cannot be written: {}", path.string(), std::strerror(errno));
  file.commit();
}

}  // namespace chromeball

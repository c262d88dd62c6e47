// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"

namespace chromeball {

namespace fs = std::filesystem;

namespace {

constexpr size_t kReadAtOnce = 8 << 20;  // bytes

// Refuses a zero byte: the system would take the path for the file whose name ends there.
void refuseNul(const fs::path& path) {
  if (path.native().find('\0') != std::string::npos)
    throwInput("{}: the file name contains U+0000", printableName(path.string()));
}

uint64_t hashOfText(std::string_view text) {
  uint64_t sum = 0;
  for (const char letter : text) sum = hash(sum ^ static_cast<unsigned char>(letter));
  return sum;
}

// A few letters.
std::string machineName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return fmt::format("{:08x}", uint32_t(hashOfText({name.data(), name.size()})));
}

// Whether the path still names a file that was opened: the process that held its lock may have
// renamed or removed it meanwhile.
bool isStillNamed(int file, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

// Creates or empties a file that no other process has locked; -1 if that is not possible.
int openLocked(const fs::path& path) {
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) return -1;
  if (flock(file, LOCK_EX | LOCK_NB) == 0 && isStillNamed(file, path) && ftruncate(file, 0) == 0)
    return file;
  close(file);
  return -1;
}

// The file's part of a temporary name: all of its name, or the beginning of a long one and a hash,
// so that a temporary file is possible wherever the file is.
std::string stemOf(const fs::path& file) {
  constexpr size_t kRest = 64;  // for the hash, the machine, the process and what is between them
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const size_t longest = size_t(std::max(pathconf(folder.c_str(), _PC_NAME_MAX), long(kRest)));
  const std::string name = file.filename().string();
  if (name.size() + kRest <= longest) return name;
  return fmt::format("{}{:016x}", name.substr(0, longest - kRest), hashOfText(name));
}

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

std::string lowerExtension(const fs::path& path) { return lowerCase(path.extension().string()); }

SharedFile::SharedFile(const fs::path& path) : path_(path) {
  checkReadable(path);
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throwInput("{}: cannot be read", path.string());
}

SharedFile::~SharedFile() { close(descriptor_); }

void SharedFile::read(uint64_t at, void* to, size_t count) const {
  for (size_t done = 0; done < count;) {
    const ssize_t more =
        pread(descriptor_, static_cast<char*>(to) + done, count - done, off_t(at + done));
    if (more > 0) done += size_t(more);
    if (more == 0 || (more < 0 && errno != EINTR))
      throwInput("{}: cannot read the whole file", path_.string());
  }
}

std::vector<uint8_t> readFile(const fs::path& path) {
  const SharedFile file(path);
  std::vector<uint8_t> bytes = longArray<uint8_t>(fs::file_size(path));
  forParts(bytes.size(), kReadAtOnce,
           [&](size_t begin, size_t end) { file.read(begin, bytes.data() + begin, end - begin); });
  return bytes;
}

FileBytes::FileBytes(const fs::path& path) {
  const SharedFile file(path);
  size_ = size_t(fs::file_size(path));
  data_.reset(new uint8_t[size_]);
  useLargePages(data_.get(), size_);
  parallelFor(size_t(0), (size_ + kReadAtOnce - 1) / kReadAtOnce, [&](size_t block) {
    const size_t begin = block * kReadAtOnce;
    file.read(begin, data_.get() + begin, std::min(kReadAtOnce, size_ - begin));
  });
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

uint64_t fingerprint(const std::string& path) {
  const std::vector<uint8_t> bytes = readFile(path);
  uint64_t state = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += sizeof state) {
    uint64_t word = 0;
    std::memcpy(&word, &bytes[i], std::min(sizeof word, bytes.size() - i));
    state = hash(state ^ word);
  }
  return state;
}

fs::path replaceableFile(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as Linux follows
  fs::path file = path;
  std::error_code error;
  for (int i = 0; fs::is_symlink(fs::symlink_status(file, error)); ++i) {
    if (i == kMostLinks)
      throwInput("{}: cannot be written: its symbolic links do not end", path.string());
    file = file.parent_path() / fs::read_symlink(file, error);  // an absolute one replaces all
    if (error) throwInput("{}: cannot be written: {}", path.string(), error.message());
  }
  const fs::file_status status = fs::status(file, error);
  const char* what = fs::is_fifo(status)                                          ? "FIFO"
                     : fs::is_character_file(status) || fs::is_block_file(status) ? "device"
                     : fs::is_socket(status)                                      ? "socket"
                                                                                  : nullptr;
  if (what)
    throwInput(
        "{}: cannot be written: it is a {}; an output is a file that appears when it is complete",
        path.string(), what);
  return file;
}

AtomicFile::AtomicFile(const fs::path& target)
    : target_(replaceableFile(target)), temporary_(target_) {
  const std::string name = fmt::format(".{}.{}", stemOf(target_), machineName());
  temporary_.replace_filename(name + ".part");
  lock_ = openLocked(temporary_);
  if (lock_ >= 0) return;
  // Another process writes the same file, or the file system has no locks.
  temporary_.replace_filename(fmt::format("{}.{}.part", name, static_cast<long>(getpid())));
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
  if (lock_ >= 0) close(lock_);
}

void AtomicFile::commit() {
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throwRun("{}: cannot be written: {}", target_.string(), error.message());
  temporary_.clear();
}

FileLock::FileLock(const std::filesystem::path& file) : path_(nameOf(file)) {
  for (;;) {
    descriptor_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throwRun("{}: cannot be created: {}", path_.string(), std::strerror(errno));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      close(descriptor_);
      throwInput("{}: is used by another process that is still rendering", file.string());
    }
    if (isStillNamed(descriptor_, path_)) {
      if (lseek(descriptor_, 0, SEEK_END) == 0) return;
      close(descriptor_);
      throwInput("{}: has contents, and would be removed as a lock; rename it", path_.string());
    }
    close(descriptor_);
  }
}

FileLock::~FileLock() {
  unlink(path_.c_str());
  close(descriptor_);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/hash.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

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

// Creates or empties a file that no other process has locked; -1 if that is not possible.
int openLocked(const fs::path& path) {
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) return -1;
  // The process that held the lock may have renamed the file after it was opened here.
  struct stat locked {
  }, named{};
  if (flock(file, LOCK_EX | LOCK_NB) == 0 && fstat(file, &locked) == 0 &&
      stat(path.c_str(), &named) == 0 && locked.st_ino == named.st_ino &&
      locked.st_dev == named.st_dev && ftruncate(file, 0) == 0)
    return file;
  close(file);
  return -1;
}

// What a temporary name has of the file's: all of it, or of a long name the begin and a hash, so
// that wherever the file can be, the temporary file can.
std::string stemOf(const fs::path& file) {
  constexpr size_t kRest = 64;  // for the hash, the machine, the process and what is between them
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const size_t longest = size_t(std::max(pathconf(folder.c_str(), _PC_NAME_MAX), long(kRest)));
  const std::string name = file.filename().string();
  if (name.size() + kRest <= longest) return name;
  return fmt::format("{}{:016x}", name.substr(0, longest - kRest), hashOfText(name));
}

}  // namespace

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
        "{}: cannot be written: it is a {}; an output is a file that appears when it is "
        "complete",
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

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace chromeball {

FileLock::FileLock(const std::filesystem::path& file) : path_(file.string() + ".lock") {
  for (;;) {
    descriptor_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throwRun("{}: cannot be created: {}", path_.string(), std::strerror(errno));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      close(descriptor_);
      throwInput("{}: is used by another process that is still rendering", file.string());
    }
    // The process that held the lock may have removed the file after it was opened here.
    struct stat locked {
    }, named{};
    if (fstat(descriptor_, &locked) == 0 && stat(path_.c_str(), &named) == 0 &&
        locked.st_ino == named.st_ino && locked.st_dev == named.st_dev)
      return;
    close(descriptor_);
  }
}

FileLock::~FileLock() {
  unlink(path_.c_str());
  close(descriptor_);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Helpers of the fuzz targets: the readers need files, the fuzzer provides bytes.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace chromeball {

// One thread is faster for such small inputs, and deterministic.
inline const ThreadLimit oneThread(1);

// Writes the bytes to a file in a folder of this process; every call overwrites the same file.
inline std::string fuzzFile(const uint8_t* bytes, size_t size, const std::string& name) {
  static const std::filesystem::path folder = [] {
    const auto base = std::filesystem::exists("/dev/shm") ? std::filesystem::path("/dev/shm")
                                                          : std::filesystem::temp_directory_path();
    const auto path = base / ("chromeball-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    static const std::filesystem::path atExitPath = path;
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(atExitPath, ignored);
    });
    return path;
  }();
  const std::string path = (folder / name).string();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), std::streamsize(size));
  return path;
}

// Invalid input must throw an InputError with a one-line message. Any other exception ends the
// fuzzer.
template <class Read>
int readOrReject(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
  return 0;
}

}  // namespace chromeball

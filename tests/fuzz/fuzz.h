// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets share: the readers take files, the fuzzer gives bytes.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"

namespace chromeball {

// Inputs are so small that a second thread only adds waiting; and one runs the same every time.
inline const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);

// The bytes as a file in a folder of this process's own; the same file every time.
inline std::string fuzzFile(const uint8_t* bytes, size_t size, const std::string& name) {
  static const std::filesystem::path folder = [] {
    const auto base = std::filesystem::exists("/dev/shm") ? std::filesystem::path("/dev/shm")
                                                          : std::filesystem::temp_directory_path();
    const auto path = base / ("chromeball-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    static const std::filesystem::path remembered = path;
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(remembered, ignored);
    });
    return path;
  }();
  const std::string path = (folder / name).string();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), std::streamsize(size));
  return path;
}

// Whatever is wrong with the input must come out as an InputError of one line; anything else that
// is thrown ends the fuzzer.
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

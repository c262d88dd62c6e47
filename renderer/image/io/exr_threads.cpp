// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_threads.h"

#include <OpenEXR/ImfThreading.h>

#include <thread>

namespace chromeball {

void useExrThreads() {
  [[maybe_unused]] static const bool once = [] {
    if (Imf::globalThreadCount() == 0)
      Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
    return true;
  }();
}

}  // namespace chromeball

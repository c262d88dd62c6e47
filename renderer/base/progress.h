// SPDX-License-Identifier: Apache-2.0
// Reports the progress of long work.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

namespace chromeball {

// Called from time to time with the fraction of the work done, in [0, 1]; NaN if unknown.
using Progress = std::function<void(double)>;

// Elapsed time.

class Stopwatch {
 public:
  // Seconds since the last lap, or since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count();
  }
  // The same, and starts the next lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace chromeball

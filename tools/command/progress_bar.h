// SPDX-License-Identifier: Apache-2.0
// A progress bar on standard error: fraction done, time elapsed and time remaining.
#pragma once

#include <chrono>

namespace chromeball {

// Draws only if `shown`, at most ten times a second.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown);
  ~ProgressBar();  // clears the line

  // `fraction` of the work done, in [0, 1]; NaN if it is unknown.
  void update(double fraction);

  static bool isTerminal();  // whether standard error is one

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_, drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_{};
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A progress bar on standard error: share done, time gone and time left.
#pragma once

#include <chrono>

namespace chromeball {

// Draws only where shown; at most ten times a second.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown);
  ~ProgressBar();  // clears the line

  // `fraction` of the work done, in [0, 1]; NaN where only the time gone is known.
  void update(double fraction);

  static bool isTerminal();  // is standard error one?

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_, drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_{};
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A progress bar on standard error: fraction done, time elapsed and time remaining, and a line of
// the caller's about the work.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace chromeball {

// Draws only if `shown`, at most ten times a second, and the end.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown, std::string title = "rendering");
  ~ProgressBar();  // clears the line

  // `fraction` of the work done, in [0, 1]; NaN if it is unknown.
  void update(double fraction);
  // Shown after the times where the terminal is wide enough, from the next update on.
  void describe(std::string text) { description_ = std::move(text); }

  static bool isTerminal();  // whether standard error is one

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_, drawn_ = false, ended_ = false;
  std::string title_, description_;
  Clock::time_point start_ = Clock::now(), last_{};
};

// The time elapsed, during work that cannot tell how much of it is done: a line that is shown from
// construction to destruction, which clears it; only on a terminal.
class BusyLine {
 public:
  explicit BusyLine(std::string title);  // of the work: "lights"
  ~BusyLine();
  BusyLine(const BusyLine&) = delete;
  BusyLine& operator=(const BusyLine&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Progress on standard error, as a bar or as lines: fraction done, time elapsed and time remaining,
// and a line of the caller's about the work.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/line_times.h"

namespace chromeball {

// Lines come as LineTimes (base/line_times.h) says.
enum class ProgressStyle { None, Bar, Lines };

// A bar is drawn at most ten times a second, and at the end.
class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style, std::string title = "rendering");
  explicit ProgressBar(bool shown, std::string title = "rendering")
      : ProgressBar(shown ? ProgressStyle::Bar : ProgressStyle::None, std::move(title)) {}
  ~ProgressBar();  // clears the line

  // `fraction` of the work done, in [0, 1]; NaN if it is unknown.
  void update(double fraction);
  // Shown after the times where the terminal is wide enough, from the next update on.
  void describe(std::string text) { description_ = std::move(text); }

  static bool isTerminal();  // whether standard error is one

 private:
  void draw(double fraction, const std::string& times);

  using Clock = std::chrono::steady_clock;
  ProgressStyle style_;
  bool drawn_ = false, ended_ = false;
  LineTimes lines_;
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

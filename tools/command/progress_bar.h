// SPDX-License-Identifier: Apache-2.0
// Progress on standard error, as a bar or as lines: fraction done, time elapsed and time remaining,
// and a line of the caller's about the work.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/progress.h"
#include "messages.h"

namespace chromeball {

// Lines come as LineTimes (base/progress.h) says.
enum class ProgressStyle { None, Bar, Lines };

// Lines where standard error is no terminal, unless the bar is asked for.
ProgressStyle progressStyle(const Verbosity& given = verbosity());

// A bar is drawn at most ten times a second, and at the end.
class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style, std::string title = "rendering");
  ~ProgressBar();  // clears the line

  // `fraction` of the work done, in [0, 1]; NaN if it is unknown.
  void update(double fraction);
  // Shown after the times where the terminal is wide enough, from the next update on.
  void describe(std::string text) { description_ = std::move(text); }

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
// construction to destruction, which clears it; on a terminal, or by --progress.
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

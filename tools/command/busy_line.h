// SPDX-License-Identifier: Apache-2.0
// The time elapsed on standard error, during work that cannot tell how much of it is done.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace chromeball {

// A line that is shown from construction to destruction, which clears it; only on a terminal.
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

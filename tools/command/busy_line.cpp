// SPDX-License-Identifier: Apache-2.0
#include "busy_line.h"

#include <limits>

#include "progress_bar.h"

namespace chromeball {

BusyLine::BusyLine(std::string title) {
  if (!ProgressBar::isTerminal()) return;
  thread_ = std::thread([this, title = std::move(title)] {
    ProgressBar bar(true, title);
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::seconds(1), [this] { return done_; }))
      bar.update(std::numeric_limits<double>::quiet_NaN());
  });
}

BusyLine::~BusyLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

#include <cmath>
#include <utility>

#include "base/error.h"

namespace chromeball {
namespace {

thread_local WorkMonitor* monitorOfThread = nullptr;

}  // namespace

MonitoredWork::MonitoredWork(WorkMonitor* monitor)
    : outer_(std::exchange(monitorOfThread, monitor)) {}
MonitoredWork::~MonitoredWork() { monitorOfThread = outer_; }

WorkMonitor* currentMonitor() { return monitorOfThread; }

void endIfCancelled() {
  if (monitorOfThread && monitorOfThread->isCancelled()) throw Interrupted("interrupted");
}

void reportWork(const char* stage, double fraction) {
  if (monitorOfThread) monitorOfThread->report(stage, fraction);
}

bool LineTimes::isDue(double fraction, double seconds) {
  constexpr double kLeast = 10, kMost = 60;
  const double since = seconds - seconds_;
  const bool isTenth = std::floor(10 * fraction) > std::floor(10 * fraction_);
  if (since < kLeast || !(isTenth || since >= kMost)) return false;
  if (!std::isnan(fraction)) fraction_ = fraction;
  seconds_ = seconds;
  return true;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

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

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

#include "base/progress.h"

namespace chromeball {
namespace {

using SizeRange = tbb::blocked_range<size_t>;

}  // namespace

std::string tbbVersion() { return TBB_runtime_version(); }

void parallelRanges(size_t count, size_t size, RangeBody body) {
  WorkMonitor* const monitor = currentMonitor();
  tbb::parallel_for(
      SizeRange(0, count, size),
      [&](const SizeRange& range) {
        const MonitoredWork work(monitor);
        endIfCancelled();
        body(range.begin(), range.end());
      },
      tbb::simple_partitioner());
}

void parallelAdaptiveRanges(size_t count, RangeBody body) {
  WorkMonitor* const monitor = currentMonitor();
  tbb::parallel_for(SizeRange(0, count), [&](const SizeRange& range) {
    const MonitoredWork work(monitor);
    if (!monitor) return body(range.begin(), range.end());
    forParts(range.size(), 1,
             [&](size_t begin, size_t end) { body(range.begin() + begin, range.begin() + end); });
  });
}

void withoutOtherWork(const std::function<void()>& body) { tbb::this_task_arena::isolate(body); }

struct ThreadSlots::Slots {
  tbb::enumerable_thread_specific<void*> addresses{nullptr};
};

ThreadSlots::ThreadSlots() : slots_(std::make_unique<Slots>()) {}
ThreadSlots::~ThreadSlots() = default;

void*& ThreadSlots::local() { return slots_->addresses.local(); }

struct ThreadLimit::Control : tbb::global_control {
  using global_control::global_control;
};

ThreadLimit::ThreadLimit(size_t count) {
  if (count > 0)
    control_ = std::make_unique<Control>(tbb::global_control::max_allowed_parallelism, count);
}
ThreadLimit::~ThreadLimit() = default;

int threadCount() {
  return int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace chromeball

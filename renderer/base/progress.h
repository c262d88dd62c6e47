// SPDX-License-Identifier: Apache-2.0
// Reports the progress of long work.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>

namespace chromeball {

// Called from time to time with the fraction of the work done, in [0, 1]; NaN if unknown.
using Progress = std::function<void(double)>;

// Elapsed time.

class Stopwatch {
 public:
  // Seconds since the last lap, or since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count();
  }
  // The same, and starts the next lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// An observer of long work, such as reading a scene: learns how far it is, and may end it.

// Called from all threads of the work.
class WorkMonitor {
 public:
  virtual ~WorkMonitor() = default;

  // Asked every few milliseconds.
  virtual bool isCancelled() const = 0;
  // The fraction of a stage that is done: 0 when it begins; NaN if unknown.
  virtual void report(const char* /*stage*/, double /*fraction*/) {}
};

// Ends the work as soon as a flag is set, which must outlive it.
class StopMonitor : public WorkMonitor {
 public:
  explicit StopMonitor(const std::atomic<bool>& stop) : stop_(stop) {}
  bool isCancelled() const override { return stop_; }

 private:
  const std::atomic<bool>& stop_;
};

// While it lives, the monitor watches this thread's work and the loops that it starts
// (base/parallel.h). Null: none, the initial state.
class MonitoredWork {
 public:
  explicit MonitoredWork(WorkMonitor* monitor);
  ~MonitoredWork();
  MonitoredWork(const MonitoredWork&) = delete;
  MonitoredWork& operator=(const MonitoredWork&) = delete;

 private:
  WorkMonitor* const outer_;
};

WorkMonitor* currentMonitor();

// Throws Interrupted if this thread's work is cancelled. For loops outside of base/parallel.h: an
// iteration may take some milliseconds, and should take at least a microsecond, since this takes
// nanoseconds.
void endIfCancelled();

void reportWork(const char* stage, double fraction);

// Calls body(begin, end) for parts of [0, count) of at most `size`, with endIfCancelled() before
// each.
template <class Body>
void forParts(size_t count, size_t size, const Body& body) {
  for (size_t begin = 0; begin < count; begin += size) {
    endIfCancelled();
    body(begin, count - begin < size ? count : begin + size);
  }
}

// When the progress of long work is worth a line of a log: a tenth more is done, or a minute has
// passed; not in the first ten seconds, nor sooner than that after another line.
class LineTimes {
 public:
  // `fraction` done may be NaN; `seconds` since the work began. If true, there is a line now.
  bool isDue(double fraction, double seconds);

 private:
  double fraction_ = 0, seconds_ = 0;  // at the last line
};

}  // namespace chromeball

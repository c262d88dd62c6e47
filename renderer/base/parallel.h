// SPDX-License-Identifier: Apache-2.0
// Loops on all threads, and values that each thread has its own copy of. An exception in a loop's
// body ends the loop. The implementation is oneTBB's, which only parallel.cpp includes: its
// templates take long to compile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace chromeball {

std::string tbbVersion();  // of the library that runs, "2021.8.0"

// Refers to a callable body(size_t begin, size_t end).
class RangeBody {
 public:
  template <class Body>
  RangeBody(const Body& body)
      : body_(&body), call_([](const void* b, size_t begin, size_t end) {
          (*static_cast<const Body*>(b))(begin, end);
        }) {}

  void operator()(size_t begin, size_t end) const { call_(body_, begin, end); }

 private:
  const void* body_;
  void (*call_)(const void*, size_t, size_t);
};

// Calls the body for ranges of at most `size` that together cover [0, count).
void parallelRanges(size_t count, size_t size, RangeBody body);

// The same as parallelRanges(), but the fewer and longer the ranges are, the less their work
// differs.
void parallelAdaptiveRanges(size_t count, RangeBody body);

// Calls the body. Loops in it do not run other loops' bodies in this thread meanwhile: those may be
// of the caller's own kind, which is in the middle of something.
void withoutOtherWork(const std::function<void()>& body);

// Calls body(i) for each i in [begin, end).
template <class Index, class Body>
void parallelFor(Index begin, Index end, const Body& body) {
  if (begin >= end) return;
  parallelAdaptiveRanges(size_t(end - begin), [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) body(Index(begin + Index(i)));
  });
}

// The number of elements that take longer than starting a task, if each takes some nanoseconds.
constexpr size_t kElementsOfTask = 1 << 14;

// Calls body(begin, end) for parts of [0, count) that together cover it; each of the `count` has
// `elements` elements. Short arrays are one part.
template <class Body>
void forRanges(size_t count, size_t elements, const Body& body) {
  const size_t size = kElementsOfTask / elements + 1;
  if (count <= size) return body(size_t(0), count);
  parallelRanges(count, size, body);
}

template <class Body>
void forRanges(size_t count, const Body& body) {
  forRanges(count, 1, body);
}

// Calls body(i) for each i below `count`; each takes as long as so many elements.
template <class Body>
void forIndices(size_t count, size_t elements, const Body& body) {
  forRanges(count, elements, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

// Calls row(y) for each row of an image; `work`: the work for a pixel, as a number of elements.
template <class Row>
void forRows(int width, int height, size_t work, const Row& row) {
  forIndices(size_t(height), work * size_t(width), [&](size_t y) { row(int(y)); });
}

template <class Row>
void forRows(int width, int height, const Row& row) {
  forRows(width, height, 1, row);
}

// The value after body(begin, end, value) for parts of [0, count) that together cover it: each part
// starts with `empty`, and join(value, later) adds them in their order. A part has about `size`
// elements or more; the parts do not depend on the threads.
template <class T, class Body, class Join>
T joinRanges(size_t count, size_t size, const T& empty, const Body& body, const Join& join) {
  constexpr size_t kMaxParts = 256;
  const size_t parts = std::min(count / size + 1, kMaxParts);
  std::vector<T> values(parts, empty);
  parallelFor(size_t(0), parts,
              [&](size_t i) { body(count * i / parts, count * (i + 1) / parts, values[i]); });
  for (size_t i = 1; i < parts; ++i) join(values[0], values[i]);
  return std::move(values[0]);
}

// The address of an object for each thread that has asked for one. local() locks nothing.
class ThreadSlots {
 public:
  ThreadSlots();
  ~ThreadSlots();

  void*& local();  // null at first

 private:
  struct Slots;
  std::unique_ptr<Slots> slots_;
};

// A T for each thread that asks for one, made by `make` in that thread.
template <class T>
class PerThread {
 public:
  PerThread() : PerThread([] { return T(); }) {}
  explicit PerThread(std::function<T()> make) : make_(std::move(make)) {}

  T& local() {
    void*& slot = slots_.local();
    if (!slot) slot = &add();
    return *static_cast<T*>(slot);
  }

  // Calls visit(value) for each value, while no thread calls local().
  template <class Visit>
  void forEach(const Visit& visit) {
    for (Value& v : values_) visit(v.value);
  }

 private:
  struct Value {
    explicit Value(const std::function<T()>& make) : value(make()) {}
    T value;
  };

  T& add() {
    const std::lock_guard lock(adding_);
    return values_.emplace_back(make_).value;
  }

  std::function<T()> make_;
  ThreadSlots slots_;
  std::mutex adding_;
  std::deque<Value> values_;
};

// Limits the number of threads as long as it lives. 0: no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(size_t count);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

// That the limits and the machine allow.
int threadCount();

}  // namespace chromeball

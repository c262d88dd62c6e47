// SPDX-License-Identifier: Apache-2.0
// A loop over long arrays, on all threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

namespace chromeball {

// Calls body(begin, end) for parts of [0, count) that together cover it; each of the `count` has
// `elements` elements. Short arrays are one part.
template <class Body>
void forRanges(size_t count, size_t elements, const Body& body) {
  constexpr size_t kMinElements = 1 << 14;
  const size_t grain = kMinElements / elements + 1;
  if (count <= grain) return body(size_t(0), count);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain),
                    [&](const tbb::blocked_range<size_t>& r) { body(r.begin(), r.end()); });
}

template <class Body>
void forRanges(size_t count, const Body& body) {
  forRanges(count, 1, body);
}

// Calls row(y) for each row of an image; `work`: of a pixel, as a number of elements.
template <class Row>
void forRows(int width, int height, size_t work, const Row& row) {
  forRanges(size_t(height), work * size_t(width), [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) row(int(y));
  });
}

template <class Row>
void forRows(int width, int height, const Row& row) {
  forRows(width, height, 1, row);
}

// The value after body(begin, end, value) for parts of [0, count) that together cover it: the parts
// start with `empty`, and join(value, later) adds what the next part found. The parts depend on the
// machine, so the result must not depend on how the range is divided.
template <class T, class Body, class Join>
T joinRanges(size_t count, const T& empty, const Body& body, const Join& join) {
  constexpr size_t kGrain = 1 << 14;
  T value = empty;
  if (count <= kGrain) {
    body(size_t(0), count, value);
    return value;
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, count, kGrain), empty,
      [&](const tbb::blocked_range<size_t>& r, T part) {
        body(r.begin(), r.end(), part);
        return part;
      },
      [&](T first, const T& later) {
        join(first, later);
        return first;
      });
}

}  // namespace chromeball

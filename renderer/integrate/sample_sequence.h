// SPDX-License-Identifier: Apache-2.0
// Which points of the Sobol sequence the samples of a pixel are.
#pragma once

#include <algorithm>
#include <cstdint>

#include "film/film.h"
#include "integrate/render_settings.h"

namespace chromeball {

// How many of a pixel's first `samples` samples belong to the half (Film).
constexpr uint32_t samplesOf(int half, uint32_t samples) {
  return samples / 2 + (half == 0 ? samples % 2 : 0);
}

// Each half of a pixel's samples is a sequence with its own randomisation. Where it is longer than
// the table, the table is used again with another one.
//
// The samples of a shard (shard.h) are points of the whole render's sequence.
class SampleSequence {
 public:
  explicit SampleSequence(const RenderSettings& settings);

  uint32_t tableSize() const { return tableSize_; }

  // Points of the table with randomisation number `table`.
  struct Run {
    uint64_t table;
    uint32_t first, count, stride;
  };

  // Calls visit(run) for those of a half's samples [begin, end) that are this shard's, in order.
  // The interval must not hold repeated samples and others.
  template <class Visit>
  void forRuns(int half, uint32_t begin, uint32_t end, const Visit& visit) const {
    const uint64_t repeated = samplesOf(half, shard_.repeated);
    uint64_t at = begin, last = end, stride = 1;
    if (shard_.isConsecutive) {
      at += shard_.first() / 2, last += shard_.first() / 2;
    } else if (end > repeated) {
      stride = shard_.count;
      at += (shard_.index + stride - (begin - repeated) % stride) % stride;
    }
    while (at < last) {
      const uint64_t index = at % tableSize_;
      const uint64_t length = std::min(tableSize_ - index, last - at);
      const uint64_t count = (length + stride - 1) / stride;
      visit(Run{at / tableSize_, uint32_t(index), uint32_t(count), uint32_t(stride)});
      at += count * stride;
    }
  }

 private:
  Shard shard_;
  uint32_t tableSize_;
};

}  // namespace chromeball

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
// The samples of a shard are points of the whole render's sequence that no other shard has. Those
// of a render with the same number of samples in all pixels are consecutive: well distributed on
// their own, and all shards together are the whole render. In an adaptive render no shard knows how
// many samples the others take in a pixel. There shard k of n has the points k, k + n, k + 2 n,
// ..., so that the union is nearly the first points of the sequence.
class SampleSequence {
 public:
  explicit SampleSequence(const RenderSettings& settings);

  uint32_t tableSize() const { return tableSize_; }
  uint32_t stride() const { return stride_; }

  // Calls visit(table, first, count) for samples [begin, end) of a half, in order: `count` points
  // from `first` on, stride() apart, of the table with randomisation number `table`.
  template <class Visit>
  void forRuns(uint64_t begin, uint64_t end, const Visit& visit) const {
    while (begin < end) {
      const uint64_t position = first_ + begin * stride_, index = position % tableSize_;
      const uint64_t inTable = (tableSize_ - index + stride_ - 1) / stride_;
      const uint64_t count = std::min(end - begin, inTable);
      visit(position / tableSize_, uint32_t(index), uint32_t(count));
      begin += count;
    }
  }

 private:
  uint32_t tableSize_, stride_ = 1;
  uint64_t first_;
};

}  // namespace chromeball

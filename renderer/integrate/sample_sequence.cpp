// SPDX-License-Identifier: Apache-2.0
#include "integrate/sample_sequence.h"

#include <bit>

namespace chromeball {
namespace {

constexpr uint64_t kLargestTable = 4096;  // samples of a half that share one randomisation
constexpr uint64_t kAdaptive = 4;         // samples of a pixel relative to the mean; some have more

}  // namespace

SampleSequence::SampleSequence(const RenderSettings& settings) : shard_(settings.shard) {
  const uint64_t spread = settings.adaptive ? kAdaptive : 1,
                 half = (uint64_t(settings.samplesOfAll()) + 1) / 2;
  tableSize_ = uint32_t(std::bit_ceil(std::min(spread * half, kLargestTable)));
}

}  // namespace chromeball

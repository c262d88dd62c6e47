// SPDX-License-Identifier: Apache-2.0
#include "relight/light_stage.h"

#include <algorithm>

#include "base/error.h"

namespace chromeball {

int stageChannels(const DirectionBasis& basis) {
  constexpr int kOthers = 6;  // colour, and the scene's own light
  return 3 * basis.size() + kOthers;
}

void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location) {
  const uint64_t numbers = uint64_t(width) * uint64_t(height) * uint64_t(stageChannels(basis));
  if (numbers > kMaxStageNumbers)
    throwInput(
        "{}: {} x {} pixels with {} elements are {} numbers; the limit is {}: take a smaller "
        "--size or fewer --directions",
        location, width, height, basis.size(), numbers, kMaxStageNumbers);
}

double elementBytes(const DirectionBasis& basis) { return 3. * sizeof(float) * basis.size(); }

void checkInMemory(const DirectionBasis& basis, int width, int height, double memory,
                   std::string_view location) {
  const double bytes = elementBytes(basis) * width * height;
  if (bytes > memory)
    throwInput("{}: {} elements of {} x {} pixels take {:.3g} GB of memory; {:.3g} GB are left",
               location, basis.size(), width, height, 1e-9 * bytes, 1e-9 * std::max(memory, 0.0));
}

}  // namespace chromeball

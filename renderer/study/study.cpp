// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <fmt/format.h>

#include "base/hash.h"

namespace chromeball {

std::string Budget::label() const {
  return timed ? fmt::format("{}s", amount) : fmt::format("{}spp", int64_t(amount));
}

uint64_t seedOf(const RenderKey& key, uint64_t studySeed) {
  constexpr uint64_t kTopBit = uint64_t(1) << 63;
  uint64_t seed = hash(studySeed, uint64_t(key.repeat));
  for (const char c : key.strategy + " " + key.budget.label()) seed = hash(seed, uint64_t(c));
  return key.strategy == kReference ? seed | kTopBit : seed & ~kTopBit;
}

RenderKey Study::referencePart(int part) const {
  const int samples = (referenceSamples + kReferenceParts - 1) / kReferenceParts;
  return {kReference, {false, double(samples)}, part};
}

std::vector<RenderKey> Study::renders() const {
  std::vector<RenderKey> keys;
  if (referenceFile.empty())
    for (int part = 0; part < kReferenceParts; ++part) keys.push_back(referencePart(part));
  for (const Budget& budget : budgets)
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const std::string& strategy : strategies) keys.push_back({strategy, budget, repeat});
  return keys;
}

}  // namespace chromeball

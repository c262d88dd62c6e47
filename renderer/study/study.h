// SPDX-License-Identifier: Apache-2.0
// A comparison of strategies as a set of renders, each of which its own seed makes independent.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chromeball {

// What a render may spend: samples a pixel, or seconds.
struct Budget {
  bool timed;
  double amount;

  std::string label() const;  // "64spp", "0.5s": exact
  bool operator==(const Budget&) const = default;
  auto operator<=>(const Budget&) const = default;  // samples, then seconds
};

// One render. The reference is a strategy of the name kReference, its parts are its repeats.
struct RenderKey {
  std::string strategy;
  Budget budget;
  int repeat = 0;
};
inline constexpr const char* kReference = "reference";

// Different for every render of a study, and never one of the reference's for a render that is
// judged by it: the reference has the top bit set, the others have not.
uint64_t seedOf(const RenderKey& key, uint64_t studySeed);

struct Study {
  std::string folder;
  std::vector<std::string> strategies;  // to be rendered; names in full
  std::vector<Budget> budgets;          // to be rendered; ascending: samples, then seconds
  int repeats = 4;                      // of each
  std::string baseline;                 // one of the strategies

  // What the results show: the above, and what runs before this one left in the folder.
  std::vector<std::string> shownStrategies;
  std::vector<Budget> shownBudgets;

  std::string referenceFile;  // empty: made on the spot, by
  std::string referenceStrategy;
  int referenceSamples = 0;
  static constexpr int kReferenceParts = 8;  // independent; how they scatter tells the error
  static constexpr int kMinRepeats = 3;      // that show how a strategy scatters

  uint64_t seed = 0;
  // What all its renders have in common; those of another study cannot be used.
  std::string identity;

  RenderKey referencePart(int part) const;
  // In the order of rendering: strategies take turns, so that a machine that drifts favours none.
  std::vector<RenderKey> renders() const;
};

}  // namespace chromeball

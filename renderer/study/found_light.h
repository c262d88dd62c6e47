// SPDX-License-Identifier: Apache-2.0
// Whether the samples of a row have found the light that the reference has.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "measure/bias_variance.h"

namespace chromeball {

enum class FoundLight {
  All,    // as far as can be seen
  Few,    // single bright samples may make up most of the error, so that its interval is too narrow
  Missed  // no or hardly any sample has met rare bright light: neither error nor bias is known
};

// The least upper end of relMSE's interval that makes FoundLight::Few: the variance above it is
// underestimated.
inline constexpr double kMaxNoiseOfPairs = 0.25;

// `unbiased`: by construction. Then a mean that is significantly below the reference's is no bias:
// light that no repeat has met is missing in the mean, and in the scatter that would tell so. Of
// other rows, it may be their bias.
FoundLight foundLight(const BiasVariance& error, bool unbiased);

struct LightOfRow {
  std::string name;
  FoundLight light;
  double bias;  // BiasVariance::bias
};

// What to say of these rows, which are not known to be biased; each is in one of the warnings at
// most. `referenceIsGiven`: it may be of another scene.
std::vector<std::string> lightWarnings(std::span<const LightOfRow> rows, bool referenceIsGiven);

}  // namespace chromeball

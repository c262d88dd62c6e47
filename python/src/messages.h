// SPDX-License-Identifier: Apache-2.0
// The library's messages in terms of keywords.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"

namespace chromeball::python {

// The end of a sentence: "; try probe_scale=0.019", or "; see memory"; empty without a remedy.
std::string inWords(const std::optional<Remedy>& remedy);

// Pairs of the kind, "note" or "warning", and the text.
std::vector<std::pair<std::string, std::string>> pairsOf(const Messages& messages);

}  // namespace chromeball::python

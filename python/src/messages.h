// SPDX-License-Identifier: Apache-2.0
// The library's messages in terms of keywords.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"

namespace chromeball::python {

// The end of a sentence: "; try probe_scale=0.019", or "; see memory"; empty without a remedy.
std::string inWords(const std::optional<Remedy>& remedy);

// The keyword of a setting, for SettingWords: "max_depth=8", "clamp".
std::string keywordInWords(std::string_view setting, const std::string& value);

// Pairs of the kind, "note" or "warning", and the text.
std::vector<std::pair<std::string, std::string>> pairsOf(const Messages& messages);

}  // namespace chromeball::python

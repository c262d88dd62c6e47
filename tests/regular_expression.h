// SPDX-License-Identifier: Apache-2.0
// std::regex, compiled once: its templates take two seconds in each file that uses them.
#pragma once

#include <optional>
#include <string>
#include <vector>

using Captures = std::vector<std::string>;  // the match, then its groups

std::optional<Captures> wholeMatch(const std::string& text, const std::string& pattern);
std::vector<Captures> allMatches(const std::string& text, const std::string& pattern);
bool containsMatch(const std::string& text, const std::string& pattern);
std::string replaceMatches(const std::string& text, const std::string& pattern,
                           const std::string& replacement);

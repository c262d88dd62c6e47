// SPDX-License-Identifier: Apache-2.0
#include "regular_expression.h"

#include <regex>

std::optional<Captures> wholeMatch(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_match(text, match, std::regex(pattern))) return {};
  return Captures(match.begin(), match.end());
}

std::vector<Captures> allMatches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<Captures> all;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    all.emplace_back(match->begin(), match->end());
  return all;
}

bool containsMatch(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, std::regex(pattern));
}

std::string replaceMatches(const std::string& text, const std::string& pattern,
                           const std::string& replacement) {
  return std::regex_replace(text, std::regex(pattern), replacement);
}

// SPDX-License-Identifier: Apache-2.0
#include "base/message.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

namespace chromeball {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// The text without what differs between messages of a kind: numbers, and names in quotation marks.
std::string withoutValues(std::string_view text) {
  constexpr std::string_view kNumber = "0123456789.eE+-";
  std::string rest;
  for (size_t i = 0; i < text.size();) {
    const char c = text[i];
    const size_t closing = c == '"' || c == '`' ? text.find(c, i + 1) : std::string_view::npos;
    if (closing != std::string_view::npos)
      i = closing + 1;
    else if (isDigit(c) || (c == '-' && i + 1 < text.size() && isDigit(text[i + 1])))
      i = std::min(text.find_first_not_of(kNumber, i), text.size());
    else
      rest += text[i++];
  }
  return rest;
}

}  // namespace

Messages condensed(const Messages& messages) {
  constexpr size_t kMostOfAKind = 3;
  using Kind = std::tuple<Message::Kind, std::string, std::string>;
  const auto kindOf = [](const Message& m) {
    return Kind(m.kind, withoutValues(m.text), m.remedy ? m.remedy->setting : "");
  };
  std::map<Kind, size_t> counts;
  for (const Message& message : messages) ++counts[kindOf(message)];
  Messages result;
  for (const Message& message : messages) {
    size_t& count = counts[kindOf(message)];
    if (count == 0) continue;  // counted by the first of its kind
    result.push_back(message);
    if (count <= kMostOfAKind) continue;
    result.back().text += fmt::format(" (and {} more of this kind)", count - 1);
    count = 0;
  }
  return result;
}

}  // namespace chromeball

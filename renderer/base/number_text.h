// SPDX-License-Identifier: Apache-2.0
// Numbers in texts, independent of the locale.
#pragma once

#include <charconv>
#include <string_view>

namespace chromeball {

// Reads a number from the front of `text` and removes it. std::from_chars() does not know a leading
// plus, which texts may have. False: there is none, or it is out of range.
template <class Number>
bool takeNumber(std::string_view& text, Number& number) {
  std::string_view rest = text;
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc()) return false;
  text = rest.substr(size_t(end - rest.data()));
  return true;
}

// The same for a text that is nothing but a number.
template <class Number>
bool toNumber(std::string_view text, Number& number) {
  return takeNumber(text, number) && text.empty();
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Text that may hold anything, such as names in hostile files, as one line for a terminal.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// The text as one line of valid UTF-8 without control characters: a line break becomes a space; an
// escape sequence of a terminal (ECMA-48: CSI and OSC) is removed; another control character, such
// as one that turns the direction of a line (right-to-left override), or a byte that is not UTF-8
// becomes `?`. Long text is shortened in its middle, with `...` there: each word to 200 bytes, the
// whole to 2000 bytes.
std::string printable(std::string_view text);

// The same for a name within a message: at most 200 bytes, also if it has spaces.
std::string printableName(std::string_view name);

// "a, b, c, d, e, f and 994 more": the first names of a list, each as by printableName().
std::string firstNames(const std::vector<std::string>& names);

std::string lowerCase(std::string_view text);  // ASCII letters

// "Did you mean ...?": suggests the known name nearest to an unknown one.

// Minimum number of single-character edits that turn `a` into `b`: insert, delete, replace, or swap
// two neighbours (optimal string alignment; Damerau 1964). O(|a| |b|).
int editDistance(std::string_view a, std::string_view b);

// The known name with the smallest edit distance from `name`, the first of several; empty if that
// distance is more than half the length of the longer name. Names longer than people type are not
// compared, nor more than a million letters.
std::string_view nearestName(std::string_view name, const std::vector<std::string_view>& known);

// The known name that differs from `name` in no more than dashes, underscores and capitals; empty
// if there is none.
std::string_view sameName(std::string_view name, const std::vector<std::string_view>& known);

// "did you mean `NEAREST`?", or "known: A, B, C" if no name is near. The end of an error message.
std::string didYouMean(std::string_view name, const std::vector<std::string_view>& known);

// The parts of a text between separators, also empty ones; at least one.
std::vector<std::string_view> splitAt(std::string_view text, char separator);

// Numbers in texts, independent of the locale.

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

// A setting whose value is a name, with the location where the user gave it.

// Only the code that uses the name (of a strategy or of a camera in the model) can check it.
// `location` is "FILE:LINE" or a command-line option; the error for an unknown name starts with it.
struct NamedSetting {
  std::string name;
  std::string location;
};

}  // namespace chromeball

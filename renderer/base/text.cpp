// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <numeric>

namespace chromeball {
namespace {

constexpr size_t kLongestWord = 200, kLongest = 2000;

// The length of the escape sequence at the begin of `text`; 0 if there is none.
size_t escapeLength(std::string_view text) {
  if (text.size() < 2 || text[0] != '\x1b') return 0;
  if (text[1] == '[') {
    const size_t end =
        std::min(text.find_first_not_of("0123456789:;<=>?!\"#$%&'()*+,-./ ", 2), text.size() - 1);
    return end + 1;
  }
  if (text[1] == ']') return std::min(text.find('\a', 2), text.size() - 1) + 1;
  return 2;
}

// The length of the UTF-8 character at the begin of `text` (RFC 3629, section 4); 0 if it is
// malformed, too long for its number, a surrogate, or a control character (U+0080 to U+009F).
size_t characterLength(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
  const auto continues = [&](size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const uint8_t a = byte(0), b = byte(1);
  if (a < 0x80) return a < ' ' || a == 0x7f ? 0 : 1;
  if (a >= 0xc2 && a <= 0xdf) return continues(1) && !(a == 0xc2 && b < 0xa0) ? 2 : 0;
  if (a >= 0xe0 && a <= 0xef) {
    const bool isValid = !(a == 0xe0 && b < 0xa0) && !(a == 0xed && b >= 0xa0);
    return isValid && continues(1) && continues(2) ? 3 : 0;
  }
  if (a >= 0xf0 && a <= 0xf4) {
    const bool isValid = !(a == 0xf0 && b < 0x90) && !(a == 0xf4 && b >= 0x90);
    return isValid && continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

// Characters that reorder a line (Unicode Standard Annex 9, tables of explicit and implicit marks):
// U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069; and characters that end one: U+2028,
// U+2029.
bool movesText(std::string_view character) {
  const auto isBetween = [&](std::string_view first, std::string_view last) {
    return character.size() == first.size() && character >= first && character <= last;
  };
  return character == "\xd8\x9c" || isBetween("\xe2\x80\x8e", "\xe2\x80\x8f") ||
         isBetween("\xe2\x80\xa8", "\xe2\x80\xae") || isBetween("\xe2\x81\xa6", "\xe2\x81\xa9");
}

bool continuesCharacter(char c) { return (uint8_t(c) & 0xc0) == 0x80; }

// The first and the last bytes of `text`, whole characters, at most `longest` in all.
std::string shortened(std::string_view text, size_t longest) {
  if (text.size() <= longest) return std::string(text);
  constexpr std::string_view kGap = "...";
  size_t head = (longest - kGap.size()) / 2, tail = text.size() - (longest - kGap.size() - head);
  while (head > 0 && continuesCharacter(text[head])) --head;
  while (tail < text.size() && continuesCharacter(text[tail])) ++tail;
  return std::string(text.substr(0, head)).append(kGap).append(text.substr(tail));
}

std::string withoutControls(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    size_t length = escapeLength(text);
    if (length == 0) {
      length = characterLength(text);
      if (length > 0)
        result += movesText(text.substr(0, length)) ? "?" : text.substr(0, length);
      else
        result += text[0] == '\n' || text[0] == '\t' || text[0] == '\r' ? ' ' : '?';
    }
    text.remove_prefix(std::max<size_t>(length, 1));
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  const std::string clean = withoutControls(text);
  std::string result;
  for (size_t begin = 0; begin < clean.size();) {
    const size_t end = std::min(clean.find(' ', begin), clean.size());
    result += shortened(std::string_view(clean).substr(begin, end - begin), kLongestWord);
    if (end < clean.size()) result += ' ';
    begin = end + 1;
  }
  return shortened(result, kLongest);
}

std::string printableName(std::string_view name) {
  return shortened(withoutControls(name), kLongestWord);
}

std::string firstNames(const std::vector<std::string>& names) {
  constexpr size_t kMost = 6;
  std::string text;
  for (size_t i = 0; i < std::min(kMost, names.size()); ++i)
    text.append(i ? ", " : "").append(printableName(names[i]));
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

int editDistance(std::string_view a, std::string_view b) {
  // Three rows of the table d(i, j) = distance between the first i letters of a and the first j of
  // b.
  std::vector<int> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = int(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
    beforeLast.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string_view nearestName(std::string_view name, const std::vector<std::string_view>& known) {
  constexpr size_t kLongest = 200;      // of names that people mistype
  constexpr size_t kLetters = 1 << 20;  // of all candidates, that are compared
  std::string_view nearest;
  if (name.size() > kLongest) return nearest;
  int nearestDistance = 0;
  size_t letters = 0;
  for (std::string_view candidate : known) {
    if (candidate.size() > kLongest) continue;
    if ((letters += candidate.size()) > kLetters) break;
    const auto [shorter, longer] = std::minmax({name.size(), candidate.size()});
    if ((longer - shorter) * 2 > longer) continue;  // the distance is at least the difference
    const int distance = editDistance(lowerCase(name), lowerCase(candidate));
    const size_t dashes = candidate.starts_with("--") ? 2 : 0;  // of options, which all have them
    if (size_t(distance) * 20 > (longer - dashes) * 9) continue;
    if (!nearest.empty() && distance >= nearestDistance) continue;
    nearest = candidate;
    nearestDistance = distance;
  }
  return nearest;
}

std::string_view sameName(std::string_view name, const std::vector<std::string_view>& known) {
  const auto plain = [](std::string_view text) {
    std::string letters = lowerCase(text);
    std::erase_if(letters, [](char c) { return c == '-' || c == '_'; });
    return letters;
  };
  const std::string letters = plain(name);
  const auto found = std::ranges::find(known, letters, plain);
  return letters.empty() || found == known.end() ? std::string_view() : *found;
}

std::string didYouMean(std::string_view name, const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearestName(name, known);
  if (nearest.empty()) return fmt::format("known: {}", fmt::join(known, ", "));
  return fmt::format("did you mean `{}`?", nearest);
}

std::vector<std::string_view> splitAt(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace chromeball

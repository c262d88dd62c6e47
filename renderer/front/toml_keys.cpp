// SPDX-License-Identifier: Apache-2.0
#include "front/toml_keys.h"

#include <algorithm>

#include "base/error.h"

namespace chromeball {
namespace {

// The position after the string or comment that begins at `begin`.
size_t endOfToken(std::string_view toml, size_t begin) {
  const char quote = toml[begin];
  if (quote == '#') return std::min(toml.find('\n', begin), toml.size());
  const std::string triple(3, quote);
  const bool isLong = toml.substr(begin).starts_with(triple);
  for (size_t at = begin + (isLong ? 3 : 1); at < toml.size(); ++at) {
    if (quote == '"' && toml[at] == '\\')
      ++at;
    else if (isLong ? toml.substr(at).starts_with(triple) : toml[at] == quote || toml[at] == '\n')
      return at + (isLong ? 3 : 1);
  }
  return toml.size();
}

}  // namespace

void checkKeyDepth(std::string_view toml, const std::string& path) {
  constexpr size_t kMostParts = 16;
  size_t dots = 0;
  for (size_t at = 0; at < toml.size();) {
    const char c = toml[at];
    if (c == '"' || c == '\'' || c == '#') {
      at = endOfToken(toml, at);
      continue;
    }
    if (c == '.') ++dots;
    if (std::string_view("\n,=[]{}").find(c) != std::string_view::npos) dots = 0;
    if (dots >= kMostParts)
      throwInput("{}:{}: a key has more than {} parts", path,
                 1 + std::count(toml.begin(), toml.begin() + ptrdiff_t(at), '\n'), kMostParts);
    ++at;
  }
}

}  // namespace chromeball

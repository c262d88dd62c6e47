// SPDX-License-Identifier: Apache-2.0
#include "image/io/unreadable.h"

#include "base/error.h"

namespace chromeball {

// Text before the path is dropped, since our message starts with the path, unless the path comes
// last. Characters that are not printable are replaced, since names in a damaged file may hold any
// bytes.
void throwUnreadable(const std::filesystem::path& path, std::string reason) {
  constexpr const char* kPunctuation = "\"'.:() \n";
  const size_t pathBegin = reason.rfind(path.string());
  if (pathBegin != std::string::npos) {
    const std::string after = reason.substr(pathBegin + path.string().size());
    const size_t textBegin = after.find_first_not_of(kPunctuation);
    if (textBegin != std::string::npos) {
      reason = after.substr(textBegin);
    } else {
      reason = reason.substr(0, pathBegin);
      reason.erase(reason.find_last_not_of(kPunctuation) + 1);
    }
  }
  reason.erase(reason.find_last_not_of(".: \n") + 1);
  for (char& c : reason)
    if (c < ' ' || c > '~') c = c == '\n' ? ' ' : '?';
  throwInput("{}: cannot be read: {}", path.string(),
             reason.empty() ? "it is damaged or of an unknown format" : reason);
}

}  // namespace chromeball

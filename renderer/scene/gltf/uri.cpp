// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace chromeball {
namespace {

namespace fs = std::filesystem;

template <class... Args>
[[noreturn]] void failUri(fmt::format_string<Args...> format, Args&&... args) {
  throw std::runtime_error(fmt::format(format, std::forward<Args>(args)...));
}

// The six bits of a base64 digit (RFC 4648, also in its URL-safe alphabet); -1 for other
// characters.
int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

bool isDataUri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return lowerCase(uri.substr(0, kScheme.size())) == kScheme;
}

bool decodeDataUri(const std::string& uri, std::vector<uint8_t>& bytes) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return false;
  if (!lowerCase(uri.substr(0, comma)).ends_with(";base64")) {
    const std::string text = decodePercent(uri.substr(comma + 1));
    bytes.assign(text.begin(), text.end());
    return true;
  }
  // Some writers escape its + / and =.
  const bool isEscaped = uri.find('%', comma) != std::string::npos;
  const std::string unescaped = isEscaped ? decodePercent(uri.substr(comma + 1)) : "";
  const std::string_view digits = isEscaped ? unescaped : std::string_view(uri).substr(comma + 1);
  bytes.reserve(digits.size() / 4 * 3);
  uint32_t bits = 0;
  int count = 0;
  for (size_t i = 0; i < digits.size() && digits[i] != '='; ++i) {
    const int bits6 = sextet(digits[i]);
    if (bits6 < 0) return false;
    bits = (bits << 6) | uint32_t(bits6);
    count += 6;
    if (count >= 8) bytes.push_back(uint8_t(bits >> (count -= 8)));
  }
  return true;
}

std::string decodePercent(const std::string& uri) {
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() &&
                        std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                        std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
    path += escape ? char(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
    if (escape) i += 2;
  }
  return path;
}

void checkFileName(const std::string& name) {
  if (name.empty()) failUri("is not a file name");
  const size_t colon = name.find(':');
  if (colon != std::string::npos && colon < name.find('/'))
    failUri("has the scheme {}; it must be a relative path", name.substr(0, colon + 1));
  const auto isForbidden = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; };
  if (std::any_of(name.begin(), name.end(), isForbidden))
    failUri("has a backslash or a control character; it must be a relative path with /");
}

void checkInside(const fs::path& folder, const std::string& name) {
  constexpr const char* kRemedy = "--allow-external permits that";
  const fs::path path(name);
  if (path.is_absolute()) failUri("is an absolute path; {}", kRemedy);
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder);
  const fs::path target = fs::weakly_canonical(root / path, error);
  if (error) failUri("cannot be found: {}", error.message());
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (end == root.end()) return;
  const bool climbs = std::find(path.begin(), path.end(), "..") != path.end();
  failUri("is outside of the model's folder {}; {}", climbs ? "by \"..\"" : "through a link",
          kRemedy);
}

}  // namespace chromeball

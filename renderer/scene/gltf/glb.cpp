// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/error.h"
#include "base/json.h"
#include "base/text.h"

namespace chromeball {
namespace {

using nlohmann::json;

constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kMaxNesting = 128;

template <class... Args>
[[noreturn]] void failWith(fmt::format_string<Args...> format, Args&&... args) {
  throw std::runtime_error(fmt::format(format, std::forward<Args>(args)...));
}

uint32_t word(std::span<const uint8_t> bytes, size_t at) {  // little-endian, as this machine
  uint32_t w;
  std::memcpy(&w, bytes.data() + at, 4);
  return w;
}

// The depth to which the brackets of a JSON text nest.
int nesting(std::span<const uint8_t> text) {
  int depth = 0, deepest = 0;
  bool inString = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const uint8_t c = text[i];
    if (c == '"') inString = !inString;
    if (inString && c == '\\') ++i;  // skip the escaped character
    if (inString) continue;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

// Converts whole numbers written as 2.0 or 2e0 to integers, as JSON and glTF define them.
void makeIntegersWhole(json& value) {
  if (value.is_structured())
    for (json& element : value) makeIntegersWhole(element);
  if (!value.is_number_float()) return;
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double x = value.get<double>();
  if (x >= 0 && x < kExact && x == std::floor(x)) value = uint64_t(x);
  if (x < 0 && x > -kExact && x == std::floor(x)) value = int64_t(x);
}

// The position of the chunk behind one of `size` bytes at `at`: after padding to 4 bytes, which
// some writers leave out.
size_t nextChunk(std::span<const uint8_t> glb, size_t at, size_t size) {
  const size_t unpadded = at + size, padded = at + (size + 3) / 4 * 4;
  const bool isUnpadded = unpadded + 8 <= glb.size() && word(glb, unpadded + 4) == kBinaryChunk;
  return isUnpadded ? unpadded : std::min(padded, glb.size());
}

}  // namespace

GltfChunks splitContainer(std::span<const uint8_t> file) {
  if (file.size() < 4 || word(file, 0) != kMagic) return {file, {}};
  if (file.size() < 20) failWith("is a truncated GLB: {} bytes", file.size());
  if (const uint32_t version = word(file, 4); version != 2)
    failWith("is glTF {}.0; convert it to glTF 2.0 (gltf-pipeline can)", version);
  const size_t length = word(file, 8);
  if (length > file.size() || length < 20)
    failWith("is a truncated GLB: its header claims {} bytes, but the file has {}", length,
             file.size());

  GltfChunks chunks;
  for (size_t at = 12; length - at >= 8;) {
    const size_t size = word(file, at);
    const uint32_t type = word(file, at + 4);
    at += 8;
    if (size > length - at)
      failWith("is a damaged GLB: a chunk claims {} bytes, but only {} are left", size,
               length - at);
    if (type == kJsonChunk && chunks.json.empty()) chunks.json = file.subspan(at, size);
    if (type == kBinaryChunk && chunks.binary.empty()) chunks.binary = file.subspan(at, size);
    at = nextChunk(file.first(length), at, size);
  }
  if (chunks.json.empty()) failWith("is a damaged GLB: it has no JSON chunk");
  return chunks;
}

json parseRoot(std::span<const uint8_t> text) {
  if (nesting(text) > kMaxNesting) failWith("nests deeper than {} levels", kMaxNesting);
  json root;
  try {
    root = parseJson(text);
  } catch (const json::exception& e) {  // "[json.exception.KIND.NUMBER] reason"
    const char* reason = std::strchr(e.what(), ']');
    failWith("is neither GLB nor JSON: {}", reason ? reason + 2 : e.what());
  }
  if (!root.is_object()) failWith("is not a JSON object");
  makeIntegersWhole(root);
  return root;
}

namespace {

namespace fs = std::filesystem;

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

void checkNoScheme(const std::string& uri) {
  const size_t colon = uri.find(':');
  if (colon != std::string::npos && colon < uri.find('/'))
    failWith("has the scheme {}; it must be a relative path", uri.substr(0, colon + 1));
}

void checkFileName(const std::string& name) {
  if (name.empty()) failWith("is not a file name");
  const auto isForbidden = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; };
  if (std::any_of(name.begin(), name.end(), isForbidden))
    failWith("has a backslash or a control character; it must be a relative path with /");
}

void checkInside(const fs::path& folder, const std::string& name) {
  constexpr const char* kRemedy = "permission (allow-external) lifts that";
  const fs::path path(name);
  if (path.is_absolute()) failWith("is an absolute path; {}", kRemedy);
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder);
  const fs::path target = fs::weakly_canonical(root / path, error);
  if (error) failWith("cannot be found: {}", error.message());
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (end == root.end()) return;
  const bool climbs = std::find(path.begin(), path.end(), "..") != path.end();
  failWith("is outside of the model's folder {}; {}", climbs ? "by \"..\"" : "through a link",
           kRemedy);
}

}  // namespace chromeball

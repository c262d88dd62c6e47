// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/glb.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/error.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kMaxNesting = 128;

template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw std::runtime_error(fmt::format(format, std::forward<Args>(args)...));
}

uint32_t word(std::span<const uint8_t> bytes, size_t at) {  // little-endian, as this machine
  uint32_t w;
  std::memcpy(&w, bytes.data() + at, 4);
  return w;
}

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

// How deep the brackets of a JSON text nest.
int nesting(std::span<const uint8_t> text) {
  int depth = 0, deepest = 0;
  bool inString = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const uint8_t c = text[i];
    if (c == '"') inString = !inString;
    if (inString && c == '\\') ++i;  // what follows is part of an escape
    if (inString) continue;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

// A whole number stays one when it is written 2.0 or 2e0, as JSON and glTF have it.
void makeIntegersWhole(json& value) {
  if (value.is_structured())
    for (json& element : value) makeIntegersWhole(element);
  if (!value.is_number_float()) return;
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double x = value.get<double>();
  if (x >= 0 && x < kExact && x == std::floor(x)) value = uint64_t(x);
  if (x < 0 && x > -kExact && x == std::floor(x)) value = int64_t(x);
}

}  // namespace

std::vector<uint8_t> readWholeFile(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail("does not exist");
  if (!std::filesystem::is_regular_file(path, error)) fail("is not a file");
  const uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) fail("cannot be read");
  std::vector<uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
  if (uintmax_t(stream.gcount()) != size) fail("cannot be read to its end");
  return bytes;
}

GltfChunks splitContainer(std::span<const uint8_t> file) {
  if (file.size() < 4 || word(file, 0) != kMagic) return {file, {}};
  if (file.size() < 20) fail("is a truncated GLB: {} bytes", file.size());
  if (const uint32_t version = word(file, 4); version != 2)
    fail("is glTF {}.0; convert it to glTF 2.0 (gltf-pipeline can)", version);
  const size_t length = word(file, 8);
  if (length > file.size() || length < 20)
    fail("is a truncated GLB: its header says {} bytes, the file has {}", length, file.size());

  GltfChunks chunks;
  for (size_t at = 12; length - at >= 8;) {
    const size_t size = word(file, at);
    const uint32_t type = word(file, at + 4);
    at += 8;
    if (size > length - at)
      fail("is a damaged GLB: a chunk of {} bytes where {} are left", size, length - at);
    if (type == kJsonChunk && chunks.json.empty()) chunks.json = file.subspan(at, size);
    if (type == kBinaryChunk && chunks.binary.empty()) chunks.binary = file.subspan(at, size);
    at = std::min(at + (size + 3) / 4 * 4, length);
  }
  if (chunks.json.empty()) fail("is a GLB without a JSON chunk");
  return chunks;
}

json parseJson(std::span<const uint8_t> text) {
  if (nesting(text) > kMaxNesting) fail("nests deeper than {} levels", kMaxNesting);
  json root;
  try {
    root = json::parse(text.begin(), text.end());
  } catch (const json::exception& e) {  // "[json.exception.KIND.NUMBER] reason"
    const char* reason = std::strchr(e.what(), ']');
    fail("is neither GLB nor JSON: {}", reason ? reason + 2 : e.what());
  }
  if (!root.is_object()) fail("is not a JSON object");
  makeIntegersWhole(root);
  return root;
}

bool decodeDataUri(const std::string& uri, std::vector<uint8_t>& bytes) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return false;
  if (!uri.substr(0, comma).ends_with(";base64")) {
    const std::string text = decodePercent(uri.substr(comma + 1));
    bytes.assign(text.begin(), text.end());
    return true;
  }
  bytes.reserve((uri.size() - comma) / 4 * 3);
  uint32_t bits = 0;
  int count = 0;
  for (size_t i = comma + 1; i < uri.size() && uri[i] != '='; ++i) {
    const int six = sextet(uri[i]);
    if (six < 0) return false;
    bits = (bits << 6) | uint32_t(six);
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
  if (name.empty()) fail("names no file");
  const size_t colon = name.find(':');
  if (colon != std::string::npos && colon < name.find('/'))
    fail("has the scheme {}; only relative paths are read", name.substr(0, colon + 1));
  const auto isForeign = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; };
  if (std::any_of(name.begin(), name.end(), isForeign))
    fail("has a backslash or a control character; only relative paths with / are read");
}

void checkInside(const fs::path& folder, const std::string& name) {
  constexpr const char* kRemedy = "which --allow-external permits";
  const fs::path path(name);
  if (path.is_absolute()) fail("is an absolute path, {}", kRemedy);
  if (std::find(path.begin(), path.end(), "..") != path.end())
    fail("leaves the model's folder by \"..\", {}", kRemedy);
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder);
  const fs::path target = fs::weakly_canonical(root / path);
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (end != root.end()) fail("leaves the model's folder through a link, {}", kRemedy);
}

}  // namespace chromeball

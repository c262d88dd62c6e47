#include "fingerprint.h"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/file.h"
#include "math/hash.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The JSON of a .gltf, or the first chunk of a .glb (glTF 2.0, 4.4): 12 bytes of header, then the
// chunk's length and kind.
json jsonOf(const std::vector<uint8_t>& bytes) {
  constexpr size_t kChunk = 20;
  auto begin = bytes.begin(), end = bytes.end();
  if (bytes.size() > kChunk && std::memcmp(bytes.data(), "glTF", 4) == 0) {
    uint32_t length;
    std::memcpy(&length, &bytes[12], sizeof length);
    begin += kChunk;
    end = begin + std::min<size_t>(length, bytes.size() - kChunk);
  }
  return json::parse(begin, end, nullptr, false);
}

std::string withoutPercents(const std::string& uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(uint8_t(uri[i + 1])) &&
                        std::isxdigit(uint8_t(uri[i + 2]));
    text += escape ? char(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
    if (escape) i += 2;
  }
  return text;
}

}  // namespace

uint64_t fingerprint(const std::string& path) {
  const std::vector<uint8_t> bytes = readFile(path);
  uint64_t state = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += sizeof state) {
    uint64_t word = 0;
    std::memcpy(&word, &bytes[i], std::min(sizeof word, bytes.size() - i));
    state = hash(state ^ word);
  }
  return state;
}

std::vector<std::string> filesNamedBy(const std::string& model) {
  const std::string extension = fs::path(model).extension().string();
  if (extension != ".gltf" && extension != ".glb") return {};
  const json root = jsonOf(readFile(model));
  std::vector<std::string> files;
  for (const char* array : {"buffers", "images"})
    for (const json& entry : root.is_object() ? root.value(array, json::array()) : json::array()) {
      if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
      const std::string uri = entry["uri"];
      if (uri.starts_with("data:")) continue;
      const fs::path file = fs::path(model).parent_path() / withoutPercents(uri);
      if (fs::is_regular_file(file)) files.push_back(file.string());
    }
  return files;
}

}  // namespace chromeball

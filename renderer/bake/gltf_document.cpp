// SPDX-License-Identifier: Apache-2.0
#include "bake/gltf_document.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/file.h"

namespace chromeball {
namespace {

constexpr int kFloat = 5126, kUint = 5125;                   // component types
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;  // targets

template <class T>
std::span<const uint8_t> bytesOf(const std::vector<T>& elements) {
  return {reinterpret_cast<const uint8_t*>(elements.data()), elements.size() * sizeof(T)};
}

std::string base64(std::span<const uint8_t> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

void appendWord(std::vector<uint8_t>& file, size_t word) {  // little-endian
  for (int shift = 0; shift < 32; shift += 8) file.push_back(uint8_t(word >> shift));
}

}  // namespace

GltfDocument::GltfDocument() {
  root = {{"asset", {{"version", "2.0"}, {"generator", "chromeball " CHROMEBALL_VERSION}}}};
}

int GltfDocument::add(const char* array, Json element) {
  root[array].push_back(std::move(element));
  return int(root[array].size()) - 1;
}

void GltfDocument::use(const std::string& extension) {
  Json& used = root["extensionsUsed"];
  if (std::find(used.begin(), used.end(), Json(extension)) == used.end()) used.push_back(extension);
}

int GltfDocument::addView(std::span<const uint8_t> bytes, int target) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (target) view["target"] = target;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return add("bufferViews", std::move(view));
}

template <int N>
int GltfDocument::accessor(const std::vector<glm::vec<N, float>>& elements) {
  Json json = {{"bufferView", addView(bytesOf(elements), kArrayBuffer)},
               {"componentType", kFloat},
               {"count", elements.size()},
               {"type", "VEC" + std::to_string(N)}};
  if constexpr (N == 3) {
    vec3 low(INFINITY), high(-INFINITY);
    for (const vec3& v : elements) low = glm::min(low, v), high = glm::max(high, v);
    json["min"] = {low.x, low.y, low.z};
    json["max"] = {high.x, high.y, high.z};
  }
  return add("accessors", std::move(json));
}

template int GltfDocument::accessor(const std::vector<vec2>&);
template int GltfDocument::accessor(const std::vector<vec3>&);
template int GltfDocument::accessor(const std::vector<vec4>&);

int GltfDocument::indices(const std::vector<glm::uvec3>& triangles) {
  return add("accessors", {{"bufferView", addView(bytesOf(triangles), kElementBuffer)},
                           {"componentType", kUint},
                           {"count", 3 * triangles.size()},
                           {"type", "SCALAR"}});
}

int GltfDocument::addPng(std::span<const uint8_t> png, const std::string& name) {
  return add("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", addView(png)}});
}

void GltfDocument::write(const std::filesystem::path& path) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  root["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
  const bool isBinary = lowerExtension(path) == ".glb";
  if (!isBinary)
    root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes_);
  std::string text = jsonText(root, isBinary ? -1 : 1);
  if (!isBinary)
    return writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const size_t length = 12 + 8 + text.size() + 8 + bytes_.size();
  if (length > std::numeric_limits<uint32_t>::max())
    throwRun("{}: {} bytes are more than a .glb can hold, 4 GiB", path.string(), length);
  std::vector<uint8_t> file;
  file.reserve(length);
  for (const size_t word : {size_t(0x46546C67), size_t(2), length, text.size(), size_t(0x4E4F534A)})
    appendWord(file, word);
  file.insert(file.end(), text.begin(), text.end());
  for (const size_t word : {bytes_.size(), size_t(0x004E4942)}) appendWord(file, word);
  file.insert(file.end(), bytes_.begin(), bytes_.end());
  writeFile(path, file);
}

}  // namespace chromeball

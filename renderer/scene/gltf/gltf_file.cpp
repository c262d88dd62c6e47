// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_file.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "scene/gltf/glb.h"
#include "scene/gltf/uri.h"

namespace chromeball {
namespace {

using nlohmann::json;

const std::set<std::string> kSupportedExtensions = {
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_variants",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
};

// How the user can avoid an unsupported extension.
const char* adviceFor(const std::string& extension) {
  if (extension == "KHR_texture_basisu")
    return "convert its KTX2 textures to PNG, JPEG or WebP (`ktx extract` of KTX-Software can)";
  if (extension == "EXT_texture_avif" || extension == "MSFT_texture_dds")
    return "export it again with PNG, JPEG or WebP textures";
  if (extension == "KHR_materials_pbrSpecularGlossiness")
    return "convert it to metallic-roughness materials";
  return "export it again without it";
}

std::string join(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::set<std::string> namesIn(const json& root, const char* key) {
  std::set<std::string> names;
  if (const auto list = root.find(key); list != root.end() && list->is_array())
    for (const json& name : *list)
      if (name.is_string()) names.insert(name.get<std::string>());
  return names;
}

json takeArray(json& root, const char* key) {
  const auto found = root.find(key);
  json array = found != root.end() && found->is_array() ? std::move(*found) : json::array();
  root.erase(key);
  return array;
}

uint64_t unsignedMember(const json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned())
    throw std::runtime_error(fmt::format("{}.{} is missing or not a whole number", where, key));
  return found->get<uint64_t>();
}

std::string stringMember(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void checkVersion(const json& root) {
  const auto asset = root.find("asset");
  const std::string version = asset == root.end() ? "" : stringMember(*asset, "version");
  if (version.starts_with("1") || version.empty())
    throw std::runtime_error(version.empty()
                                 ? "has no asset.version; it must be \"2.0\""
                                 : "is glTF 1.0; convert it to glTF 2.0 (gltf-pipeline can)");
  const std::string minimum = stringMember(*asset, "minVersion");
  if (!version.starts_with("2.") || (!minimum.empty() && minimum != "2.0"))
    throw std::runtime_error(fmt::format("requires glTF {}; only 2.0 is supported",
                                         minimum.empty() ? version : minimum));
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// tinygltf rejects three things that the specification allows: a skin without inverse bind
// matrices, an animation channel without a node (an extension may define its target), and indices
// whose accessor has no buffer view. The first two get the index -1, tinygltf's "none". Accessors
// without a buffer view get an additional dummy view, whose index is returned.
int fillGaps(json& root) {
  for (json& skin : root["skins"])
    if (skin.is_object() && !skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
  for (json& animation : root["animations"])
    if (animation.is_object() && animation.contains("channels"))
      for (json& channel : animation["channels"])
        if (channel.is_object() && channel.contains("target") && channel["target"].is_object() &&
            !channel["target"].contains("node"))
          channel["target"]["node"] = -1;
  json& views = root["bufferViews"];
  const int none = int(views.size());
  for (json& accessor : root["accessors"])
    if (accessor.is_object() && !accessor.contains("bufferView")) accessor["bufferView"] = none;
  views.push_back({{"buffer", 0}, {"byteLength", 1}});
  return none;
}

// tinygltf rejects these skins without giving a reason.
void checkSkins(const json& root) {
  const auto skins = root.find("skins");
  if (skins == root.end() || !skins->is_array()) return;
  for (size_t i = 0; i < skins->size(); ++i) {
    const json& skin = (*skins)[i];
    if (!skin.is_object()) continue;
    const auto joints = skin.find("joints");
    const bool areNodes = joints != skin.end() && joints->is_array() &&
                          std::all_of(joints->begin(), joints->end(),
                                      [](const json& joint) { return joint.is_number_integer(); });
    if (!areNodes)
      throw std::runtime_error(
          fmt::format("skins[{}].joints: is missing or not a list of node indices", i));
  }
}

}  // namespace

std::string oneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  return text;
}

GltfFile::GltfFile(const std::string& path, ExternalFiles external)
    : path_(path), files_{path}, external_(external) {
  try {
    file_ = FileBytes(path);
    const GltfChunks chunks = splitContainer(file_.bytes());
    json root = parseJson(chunks.json);
    checkVersion(root);
    checkExtensions(root);
    readBuffers(takeArray(root, "buffers"), chunks.binary);
    for (const json& image : takeArray(root, "images")) {
      const auto view = image.find("bufferView");
      const bool inView = view != image.end() && view->is_number_integer();
      images.push_back({inView ? view->get<int>() : -1, stringMember(image, "uri")});
      addToFiles(images.back().uri);
    }
    readModel(root);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {  // from JSON and glb.h
    fail("{}", firstLine(e.what()));
  }
}

void GltfFile::checkExtensions(const json& root) {
  for (const std::string& name : namesIn(root, "extensionsRequired"))
    if (!kSupportedExtensions.contains(name))
      fail("requires the extension {}, which is not supported; {}", name, adviceFor(name));
  std::set<std::string> ignored = namesIn(root, "extensionsUsed");
  for (const std::string& name : kSupportedExtensions) ignored.erase(name);
  if (!ignored.empty()) warnOnce("ignored extensions: " + join(ignored));
}

// We open the files and not tinygltf, because it would also search the working directory, and
// because it reads images before their buffer views are checked.
void GltfFile::readBuffers(const json& buffers, std::span<const uint8_t> binaryChunk) {
  uint64_t total = file_.bytes().size();
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string where = fmt::format("buffers[{}]", i);
    const uint64_t length = unsignedMember(buffers[i], "byteLength", where);
    const std::string uri = stringMember(buffers[i], "uri");
    std::span<const uint8_t> bytes = i == 0 ? binaryChunk : std::span<const uint8_t>();
    if (!uri.empty()) {
      addToFiles(uri);
      storage_.push_back(readUri(uri, where + ".uri"));
      bytes = storage_.back();
    }
    // A buffer may have no bytes at all (the fallback of an extension) if they are never read.
    if (bytes.size() < length && !(bytes.empty() && uri.empty()))
      fail("{}: byteLength is {}, but there are only {} bytes", where, length, bytes.size());
    buffers_.push_back(bytes.first(std::min<uint64_t>(length, bytes.size())));
    total += buffers_.back().size();
  }
  budget_ = (uint64_t(1) << 27) + 256 * total;
}

void GltfFile::readModel(json& root) {
  checkSkins(root);
  const int noView = fillGaps(root);
  const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > std::numeric_limits<unsigned>::max()) fail("has more than 4 GiB of JSON");
  std::string error, warning;
  tinygltf::TinyGLTF reader;
  const bool read =
      reader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "");
  error.erase(0, error.find_first_not_of(" \n"));
  if (!read || !error.empty())
    fail("is not well-formed glTF: {}",
         error.empty() ? "a required member is missing or has the wrong type" : firstLine(error));
  model.bufferViews.pop_back();
  for (tinygltf::Accessor& accessor : model.accessors)
    if (accessor.bufferView == noView) accessor.bufferView = -1;
}

std::span<const uint8_t> GltfFile::view(int bufferView, const std::string& where) const {
  const tinygltf::BufferView& v = at(model.bufferViews, bufferView, "bufferViews", where);
  return bytes(v.buffer, v.byteOffset, v.byteLength,
               fmt::format("{}: bufferViews[{}]", where, bufferView));
}

std::span<const uint8_t> GltfFile::bytes(int index, size_t offset, size_t length,
                                         const std::string& where) const {
  const std::span<const uint8_t> buffer = at(buffers_, index, "buffers", where);
  if (buffer.empty()) fail("{}: buffers[{}] has no bytes", where, index);
  if (offset > buffer.size() || length > buffer.size() - offset)
    fail("{}: bytes {} to {} are outside of buffers[{}], which has {} bytes", where, offset,
         double(offset) + double(length), index, buffer.size());
  return buffer.subspan(offset, length);
}

int GltfFile::addView(Bytes bytes) {
  storage_.push_back(std::move(bytes));
  buffers_.push_back(storage_.back());
  tinygltf::BufferView view;
  view.buffer = int(buffers_.size()) - 1;
  view.byteLength = storage_.back().size();
  model.bufferViews.push_back(view);
  return int(model.bufferViews.size()) - 1;
}

std::span<const uint8_t> GltfFile::image(int index, Bytes& storage) const {
  const std::string where = fmt::format("images[{}]", index);
  const ImageSource& source = at(images, index, "images", where);
  if (source.bufferView >= 0) return view(source.bufferView, where);
  if (source.uri.empty()) fail("{}: has neither uri nor bufferView", where);
  storage = readUri(source.uri, where + ".uri");
  return storage;
}

std::string GltfFile::describeImage(int index) const {
  const std::string& uri = images[size_t(index)].uri;
  const bool named = !uri.empty() && !uri.starts_with("data:");
  return fmt::format("{}: images[{}]{}", path_, index, named ? " (" + oneLine(uri) + ")" : "");
}

void GltfFile::addToFiles(const std::string& uri) {
  if (uri.empty() || uri.starts_with("data:")) return;
  files_.push_back((std::filesystem::path(path_).parent_path() / decodePercent(uri)).string());
}

Bytes GltfFile::readUri(const std::string& uri, const std::string& where) const {
  if (uri.starts_with("data:")) {
    Bytes bytes;
    if (!decodeDataUri(uri, bytes)) fail("{}: invalid data URI", where);
    return bytes;
  }
  const std::string name = decodePercent(uri);
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  try {
    checkFileName(name);
    if (external_ == ExternalFiles::Refuse) checkInside(folder, name);
  } catch (const std::exception& e) {
    fail("{}: \"{}\" {}", where, name, e.what());
  }
  try {
    return readFile(folder / name);
  } catch (const std::exception& e) {
    fail("{}: {}", where, e.what());
  }
}

void GltfFile::warnOnce(const std::string& what) {
  std::string line = path_ + ": " + oneLine(what);
  if (known_.insert(line).second) warnings_.push_back(std::move(line));
}

void GltfFile::beginLoad() {
  if (!opened_) opened_ = Opened{warnings_.size(), spent_};
  warnings_.resize(opened_->warnings);
  known_ = {warnings_.begin(), warnings_.end()};
  spent_ = opened_->spent;
}

void GltfFile::spend(uint64_t bytes) {
  spent_ += bytes;
  if (bytes > budget_ || spent_ > budget_)
    fail("needs more than {} bytes of geometry, out of proportion to the length of the file",
         budget_);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_file.h"

#include <algorithm>
#include <limits>

#include "base/json.h"
#include "base/text.h"
#include "scene/gltf/glb.h"
#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using nlohmann::json;

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

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
    json root = parseRoot(chunks.json);
    checkVersion(root);
    checkMemberTypes(root);
    if (const auto ignored = checkExtensions(root); !ignored.empty())
      warnOnce("ignored extensions: " + firstNames({ignored.begin(), ignored.end()}));
    readBuffers(takeArray(root, "buffers"), chunks.binary);
    for (const json& image : takeArray(root, "images")) {
      images.push_back({image.value("bufferView", -1), stringMember(image, "uri")});
      addToFiles(images.back().uri);
    }
    readModel(root);
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& e) {  // from JSON and glb.h
    fail("{}", firstLine(e.what()));
  }
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
  requireJoints(root);
  const int noView = fillGaps(root);
  keepLargeNumbers(root);
  const std::string text = jsonText(root);
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
  const bool named = !uri.empty() && !isDataUri(uri);
  return fmt::format("{}: images[{}]{}", path_, index,
                     named ? " (" + printableName(uri) + ")" : "");
}

void GltfFile::addToFiles(const std::string& uri) {
  if (uri.empty() || isDataUri(uri)) return;
  files_.push_back((std::filesystem::path(path_).parent_path() / decodePercent(uri)).string());
}

Bytes GltfFile::readUri(const std::string& uri, const std::string& where) const {
  if (isDataUri(uri)) {
    Bytes bytes;
    if (!decodeDataUri(uri, bytes)) fail("{}: invalid data URI", where);
    return bytes;
  }
  const std::string name = decodePercent(uri);
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  try {
    checkNoScheme(uri);
    checkFileName(name);
    if (external_ == ExternalFiles::Refuse) checkInside(folder, name);
  } catch (const std::exception& e) {
    fail("{}: \"{}\" {}", where, printableName(name), e.what());
  }
  try {
    return readFile(folder / name);
  } catch (const Interrupted&) {
    throw;
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

// SPDX-License-Identifier: Apache-2.0
// A glTF file opened: its JSON as tinygltf's model, its bytes behind bounds checks.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

using Bytes = std::vector<uint8_t>;

// Where the encoded bytes of an image are: in a buffer view, or else at a URI.
struct ImageSource {
  int bufferView = -1;
  std::string uri;
};

// A string of the file made fit for a message: control characters become '?'.
std::string oneLine(std::string text);

class GltfFile {
 public:
  // Reads the file and its buffers. Throws InputError where it is not glTF 2.0, requires an
  // extension that is not supported, or names a buffer that is missing or where `external` forbids.
  GltfFile(const std::string& path, Warn warn, ExternalFiles external);

  tinygltf::Model model;  // without buffers and images
  std::vector<ImageSource> images;

  // The file itself and those that its buffers and images name.
  const std::vector<std::string>& files() const { return files_; }

  // A part of a buffer. `where` names the user of it in the message.
  std::span<const uint8_t> bytes(int buffer, size_t offset, size_t length,
                                 const std::string& where) const;

  // Appends a buffer view of its own buffer to the model; returns its index.
  int addView(Bytes bytes);

  // The bytes of a buffer view. `where` names the user of it in the message.
  std::span<const uint8_t> view(int bufferView, const std::string& where) const;

  // The encoded bytes of an image; `storage` holds them where they come from outside the buffers.
  std::span<const uint8_t> image(int index, Bytes& storage) const;
  std::string describeImage(int index) const;  // for messages: "FILE: images[3] (wood.png)"

  // Element `index` of one of the file's arrays. Throws InputError where there is none.
  template <class T>
  const T& at(const std::vector<T>& array, int index, const char* name,
              const std::string& where) const {
    if (index < 0 || size_t(index) >= array.size())
      fail("{}: {}[{}] does not exist ({} in the file)", where, name, index, array.size());
    return array[size_t(index)];
  }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(path_ + ": " + oneLine(fmt::format(format, std::forward<Args>(args)...)));
  }

  // Says a warning, the same one only once.
  void warnOnce(const std::string& what);

  // Accounts for memory the file makes us fill. References let a small file ask for much: throws
  // InputError where the sum is out of proportion to the bytes of the file.
  void spend(uint64_t bytes);

 private:
  void checkExtensions(const nlohmann::json& root);
  void readBuffers(const nlohmann::json& buffers, std::span<const uint8_t> binaryChunk);
  void readModel(nlohmann::json& root);
  void note(const std::string& uri);  // among files()
  Bytes resolve(const std::string& uri, const std::string& where) const;

  std::string path_;
  std::vector<std::string> files_;
  Warn warn_;
  ExternalFiles external_;
  std::set<std::string> said_;
  Bytes file_;                  // the GLB's buffer lies in here
  std::vector<Bytes> storage_;  // of buffers outside it
  std::vector<std::span<const uint8_t>> buffers_;
  uint64_t spent_ = 0, budget_ = 0;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// An open glTF file: its JSON as tinygltf's model, its bytes behind bounds checks.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

using Bytes = std::vector<uint8_t>;

// The location of an image's encoded bytes: a buffer view, or else a URI.
struct ImageSource {
  int bufferView = -1;
  std::string uri;
};

// A string from the file for use in a message: control characters become '?'.
std::string oneLine(std::string text);

struct AnimationTracks;

class GltfFile {
 public:
  // Reads the file and its buffers. Throws InputError if it is not glTF 2.0, requires an
  // unsupported extension, or refers to a buffer file that is missing or that `external` forbids.
  GltfFile(const std::string& path, ExternalFiles external);

  tinygltf::Model model;  // without buffers and images
  std::vector<ImageSource> images;
  std::vector<bool> animated;  // by node: whether the chosen animation sets it; empty: none
  std::shared_ptr<AnimationTracks> tracks;  // of scene/gltf/animation.cpp: samplers that were read

  // The paths of the file itself and of the files of its buffers and images.
  const std::vector<std::string>& files() const { return files_; }

  // In all that follow, `where` is the location in the file that messages start with.

  // A range of a buffer. Throws InputError if it exceeds the buffer.
  std::span<const uint8_t> bytes(int buffer, size_t offset, size_t length,
                                 const std::string& where) const;

  // Appends a buffer and a buffer view of all of it to the model; returns the index of the view.
  int addView(Bytes bytes);

  // The bytes of a buffer view.
  std::span<const uint8_t> view(int bufferView, const std::string& where) const;

  // The encoded bytes of an image. If they are not in a buffer, they are read into `storage`.
  std::span<const uint8_t> image(int index, Bytes& storage) const;
  std::string describeImage(int index) const;  // for messages: "FILE: images[3] (wood.png)"

  // Element `index` of one of the file's arrays, which is called `name`. Throws InputError if it
  // does not exist.
  template <class Array>
  auto& at(Array& array, int index, const char* name, const std::string& where) const {
    if (index < 0 || size_t(index) >= array.size())
      fail("{}: {}[{}] does not exist ({} in the file)", where, name, index, array.size());
    return array[size_t(index)];
  }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(path_ + ": " + oneLine(fmt::format(format, std::forward<Args>(args)...)));
  }

  // Adds a warning, "FILE: what"; the same one only once.
  void warnOnce(const std::string& what);
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Records memory that is about to be allocated for the file's contents. Because of references, a
  // small file can require much memory: throws InputError if the sum is out of proportion to the
  // length of the file.
  void spend(uint64_t bytes);

  // A file can be loaded several times: the first call keeps what has been recorded and warned of
  // since the file was opened, later ones go back to it.
  void beginLoad();

 private:
  void readBuffers(const nlohmann::json& buffers, std::span<const uint8_t> binaryChunk);
  void readModel(nlohmann::json& root);
  void addToFiles(const std::string& uri);
  Bytes readUri(const std::string& uri, const std::string& where) const;

  std::string path_;
  std::vector<std::string> files_;
  ExternalFiles external_;
  std::vector<std::string> warnings_;
  std::set<std::string> known_;  // the warnings, to tell repeated ones
  FileBytes file_;               // includes the GLB's buffer
  std::vector<Bytes> storage_;   // the other buffers
  std::vector<std::span<const uint8_t>> buffers_;
  uint64_t spent_ = 0, budget_ = 0;
  struct Opened {
    size_t warnings;
    uint64_t spent;
  };
  std::optional<Opened> opened_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Writes small glTF files for tests, each into its own folder, which the destructor removes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "scene/scene.h"

namespace chromeball {

enum ComponentType { kByte = 5120, kUByte, kShort, kUShort, kUInt = 5125, kFloat };

extern const std::vector<uint8_t> kPng;  // a 2 x 1 RGB PNG: (255 0 0) (0 128 255)

class GltfWriter {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::string> warnings;  // of the last load()

  GltfWriter();
  ~GltfWriter();
  GltfWriter(const GltfWriter&) = delete;
  GltfWriter& operator=(const GltfWriter&) = delete;

  std::filesystem::path folder() const { return folder_; }

  // Appends bytes to the buffer; returns the index of their buffer view.
  template <class T>
  int view(const std::vector<T>& elements, int stride = 0) {
    return bytesView(elements.data(), elements.size() * sizeof(T), stride);
  }

  int accessor(int view, ComponentType component, const std::string& type, size_t count,
               size_t offset = 0, bool normalized = false);

  int vec3s(const std::vector<float>& f);
  int vec2s(const std::vector<float>& f);
  int indices(const std::vector<uint16_t>& i);

  // Appends to an array of the root; returns the index.
  int add(const std::string& array, const nlohmann::json& element);

  int mesh(const nlohmann::json& primitive);

  void write(const std::string& name, const std::vector<uint8_t>& bytes) const;

  std::string save();

  Scene load(const Transform& placement = {});

  // The message with which the file is rejected, without the path; "" if it loads.
  std::string errorMessage();

 private:
  int bytesView(const void* data, size_t size, int stride);

  std::filesystem::path folder_;
  std::vector<uint8_t> bytes_;
};

// A node that shows a mesh of one triangle, (0,0,0) (1,0,0) (0,1,0), with the given additions.
int addTriangle(GltfWriter& w, const nlohmann::json& primitive = {},
                const nlohmann::json& node = {});

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A glTF file to be written: its JSON, and the bytes of its only buffer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/json.h"
#include "math/vec.h"

namespace chromeball {

class GltfDocument {
 public:
  using Json = nlohmann::ordered_json;

  GltfDocument();

  Json root;

  // Appends an element to an array of the root; returns its index.
  int add(const char* array, Json element);

  // Accessors of vertices, and of indices.
  template <int N>  // 2 to 4; for 3 with bounds, which positions need
  int accessor(const std::vector<glm::vec<N, float>>& elements);
  int indices(const std::vector<glm::uvec3>& triangles);

  int addPng(std::span<const uint8_t> png, const std::string& name);

  // Names an extension that the file uses.
  void use(const std::string& extension);

  // Writes a .glb, or for another extension a .gltf with its bytes in data URIs; atomically. Throws
  // RunError.
  void write(const std::filesystem::path& path);

 private:
  int addView(std::span<const uint8_t> bytes, int target = 0);

  std::vector<uint8_t> bytes_;
};

}  // namespace chromeball

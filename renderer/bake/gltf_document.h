// SPDX-License-Identifier: Apache-2.0
// A glTF file to be written: its JSON, the bytes of its only buffer, and its materials.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "base/json.h"
#include "math/vec.h"
#include "scene/scene.h"

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

// Writes the materials of a scene into a glTF file.

// The UV set of lightmaps; the material's own sets from there on move up by one.
inline constexpr int kLightmapSet = 1;

class GltfMaterials {
 public:
  using Json = GltfDocument::Json;

  // Both arguments must outlive this. `movesSets`: the file has a lightmap's UV set.
  GltfMaterials(const Scene& scene, GltfDocument& document, bool movesSets)
      : scene_(scene), document_(document), movesSets_(movesSets) {}

  // The core's metallic-roughness material, with index of refraction, specular and the strength of
  // emission; other extensions are left out.
  Json lit(const Material& material);
  // Shows the base colour as it is: its texture and factor, times vertex colours.
  Json unlit(const Material& material);
  // Shows the texture of this index on the lightmap's UV set as it is.
  Json lightmapped(const Material& material, int texture);
  // Shows vertex colours as they are.
  Json coloured(const Material& material);

  // A texture of a PNG that is interpolated and does not repeat.
  int addPage(std::span<const uint8_t> png, const std::string& name);

 private:
  Json common(const Material& material, const Json& pbr);
  Json shown(const Material& material, const Json& pbr);  // with KHR_materials_unlit
  Json textureInfo(const TextureSlot& slot);
  int textureOf(int index);
  int imageOf(const Texture& texture);

  const Scene& scene_;
  GltfDocument& document_;
  bool movesSets_;
  std::map<int, int> textures_;                              // by index in the scene
  std::map<std::pair<const TexelGrid*, bool>, int> images_;  // with the encoding
};

// 8 bits per channel; RGB sRGB-encoded if asked for, clipped to [0, 1]. Three channels if the image
// has three or its alpha is 1 everywhere.
std::vector<uint8_t> pngOf(const Image& linear, bool srgb);

}  // namespace chromeball

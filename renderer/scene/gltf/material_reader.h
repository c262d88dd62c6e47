// SPDX-License-Identifier: Apache-2.0
// Turns glTF materials, textures, samplers and images into the scene's.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

// Converts on demand, so that what no primitive uses costs nothing.
class MaterialReader {
 public:
  explicit MaterialReader(GltfFile& file) : file_(file) {}

  // Index into the scene's materials of glTF material `index`; -1 stands for the default material.
  int use(int index, const std::string& where);
  const Material& operator[](int material) const { return materials_[size_t(material)]; }

  // Decodes the images in use, each once and in parallel, and hands everything over.
  void moveInto(Scene& scene);

 private:
  using TextureKey = std::tuple<int, Wrap, Wrap, Filter, bool, bool>;
  struct TexelUse {
    bool srgb = false, weightedByAlpha = false;  // as of Texture
  };

  Material convert(const tinygltf::Material& source, const std::string& where);
  TextureSlot slot(int texture, int uvSet, const tinygltf::ExtensionMap& extensions, TexelUse use,
                   const std::string& where);
  TextureSlot slot(const tinygltf::Value& textureInfo, bool srgb, const std::string& where);
  int texture(int index, TexelUse use, const std::string& where);
  TexelGrid* grid(int image);
  void readSpecular(const tinygltf::Value& extension, const std::string& where, Material& m);
  // Nothing where the extensions change nothing.
  std::optional<ExtendedMaterial> readExtensions(const tinygltf::ExtensionMap& extensions,
                                                 const std::string& where);
  void readTransmission(const tinygltf::ExtensionMap& extensions, const std::string& where,
                        ExtendedMaterial& m);
  void readClearcoat(const tinygltf::Value& extension, const std::string& where,
                     ExtendedMaterial& m);
  void readSheen(const tinygltf::Value& extension, const std::string& where, ExtendedMaterial& m);
  void readAnisotropy(const tinygltf::Value& extension, const std::string& where,
                      ExtendedMaterial& m);
  void readIridescence(const tinygltf::Value& extension, const std::string& where,
                       ExtendedMaterial& m);

  GltfFile& file_;
  std::map<int, int> materialOf_;  // glTF's index to ours
  std::vector<Material> materials_;
  std::map<TextureKey, int> textureOf_;
  std::vector<Texture> textures_;
  std::map<int, int> gridOf_;  // image to grid
  std::vector<std::unique_ptr<TexelGrid>> grids_;
  std::vector<int> imageOf_;  // grid to image
};

}  // namespace chromeball

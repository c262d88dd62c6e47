// SPDX-License-Identifier: Apache-2.0
// Converts glTF materials, textures, samplers and images to the scene's.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"
#include "scene/scene.h"

namespace chromeball {

struct TexelUse {
  bool srgb = false, weightedByAlpha = false;  // see Texture
};

// Converts on demand, so that unused materials and images cost nothing.
class MaterialReader {
 public:
  // `cache` receives the decoded images; null: none.
  MaterialReader(GltfFile& file, TexelCache* cache) : file_(file), cache_(cache) {}

  // Converts glTF material `index` (-1: the default material); returns its index in the scene.
  int use(int index, const std::string& where);
  const Material& operator[](int material) const { return materials_[size_t(material)]; }

  // Decodes the images in use that the cache lacks, in parallel, and moves all results into the
  // scene.
  void moveInto(Scene& scene);

  // The object of a material's extension, with its place in the file.
  struct Extension {
    MaterialReader& reader;
    const tinygltf::Value& object;
    std::string where;

    float number(const char* key, double fallback, double low = 0, double high = 1) const;
    Rgb color(const char* key, const Rgb& fallback, double high = 1) const;
    TextureSlot texture(const char* key, TexelUse use = {}) const;
  };

 private:
  using TextureKey = std::tuple<int, Wrap, Wrap, Filter, bool, bool>;

  std::optional<Extension> find(const tinygltf::ExtensionMap& extensions, const char* name,
                                const std::string& where);

  Material convert(const tinygltf::Material& source, const std::string& where);
  TextureSlot slot(int texture, int uvSet, const tinygltf::ExtensionMap& extensions, TexelUse use,
                   const std::string& where);
  template <class Info>  // of tinygltf
  TextureSlot slot(const Info& info, TexelUse use, const std::string& where) {
    return slot(info.index, info.texCoord, info.extensions, use, where);
  }
  int texture(int index, TexelUse use, const std::string& where);
  TexelGrid* grid(int image);
  void readBaseColor(const tinygltf::Material& source, TexelUse use, const std::string& where,
                     Material& m);
  static void readSpecularGlossiness(const Extension& e, TexelUse diffuse, Material& m);
  // nullopt if the extensions have no effect.
  std::optional<ExtendedMaterial> readExtensions(const tinygltf::ExtensionMap& extensions,
                                                 const std::string& where);

  GltfFile& file_;
  TexelCache* cache_;
  std::map<int, int> materialOf_;  // glTF index to index in the scene
  std::vector<Material> materials_;
  std::map<TextureKey, int> textureOf_;
  std::vector<Texture> textures_;
  std::map<int, int> gridOf_;  // image to grid
  std::vector<std::shared_ptr<TexelGrid>> grids_;
  std::vector<int> imageOf_;  // grid to image
};

// The names of the file's sets of materials, in its order.
inline constexpr const char* kVariantsExtension = "KHR_materials_variants";
std::vector<std::string> variantNames(const GltfFile& file);

// Decodes the images of a model, into memory or a temporary file.

// Mip levels to make for an image; see makeMipLevels().
struct ChainToMake {
  bool srgb = false, weightedByAlpha = false;
  MipChain* chain = nullptr;
};

struct ImageToDecode {
  int image = 0;              // index in the file
  TexelGrid* grid = nullptr;  // filled unless it already is
  std::vector<ChainToMake> chains;
};

// Decodes the images that are missing, in parallel. If all together would exceed `cache.memory`,
// they go to `cache.file`, one after another. Throws InputError for a damaged image, and, before
// any is decoded, if all together exceed `cache.limit`; RunError if the temporary file cannot be
// written.
void decodeImages(const GltfFile& file, const std::vector<ImageToDecode>& images,
                  TexelCache& cache);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What is in a glTF file, for a person who is about to render it.
#pragma once

#include <string>
#include <vector>

#include "scene/bounds.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

// Lists are in the order of the file.
struct ModelInfo {
  // With all nodes below it.
  struct Node {
    std::string name;
    int parent;  // -1: a root
    int depth;   // 0: a root
    size_t triangles = 0;
    Bounds bounds;  // of the rest pose, metres; empty without triangles
  };
  struct Material {
    std::string name;
    std::vector<std::string> extensions;
    std::string alphaMode;  // OPAQUE, MASK or BLEND
    bool isDoubleSided, emits;
    int textures;  // images, of the core properties and extensions
  };
  struct Texture {  // decoded: of materials in use
    std::string image;
    int width, height;
    size_t bytes;
  };
  struct Animation {
    std::string name;
    double seconds;  // the latest key
    size_t channels;
  };
  struct Extension {
    std::string name;
    bool isRequired, isSupported;
  };

  std::string generator;  // empty: not stated
  Scene scene;            // in its rest pose, with the textures decoded
  std::vector<Node> nodes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Animation> animations;
  std::vector<std::string> variants;
  std::vector<Extension> extensions;
  std::vector<std::string> warnings;  // what was ignored or repaired
};

// Throws InputError as loadGltf() does.
ModelInfo modelInfo(const std::string& path, ExternalFiles external);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Scenes from memory.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "scene/light.h"
#include "scene/scene.h"

namespace chromeball {

struct TextureSampler {
  Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
  Filter filter = Filter::Linear;
};

// Adds to a scene, so that one made of arrays is as sound as one read from a file: values are
// checked, normals and tangents completed, mip levels made. All functions throw InputError, which
// names the array or value and the index of the error, and then leave the scene as it was. The
// numbers that they return are indices into the scene's lists.
class SceneBuilder {
 public:
  // The scene must outlive this. Scenes that are built apart may be joined by append().
  explicit SceneBuilder(Scene& scene) : scene_(scene) {}

  // `parent`: an earlier node; -1: none.
  int addNode(std::string name, int parent = -1);

  // An image of four channels: 8 bits, or floats of any finite value from 0. Textures that differ
  // in their samplers share it.
  int addImage(TexelGrid image);
  // A slot of a material. `srgb`: whether RGB is encoded in sRGB, as in images of colours with 8
  // bits, but not in images of roughness, normals and other numbers. Makes the mip levels.
  TextureSlot addTexture(int image, bool srgb, const TextureSampler& sampler = {});

  // Its texture slots come from addTexture(). Numbers are in the ranges of glTF 2.0 and its
  // extensions.
  int addMaterial(Material material);

  // A mesh for one or several instances, with the arrays that this material needs (mesh.h); other
  // materials may use it if they need no further arrays. Without triangles, its vertices are taken
  // in threes.
  int addMesh(Mesh mesh, int material);
  // The same for a mesh whose arrays are complete, and finite; only their lengths and the vertices
  // of the triangles are checked.
  int addMesh(MeshList::Shared mesh);

  // Without a transform, the mesh is in world space: rays are faster in one that has no other
  // instance.
  void addInstance(int mesh, int material, int node,
                   const std::optional<Transform>& toWorld = std::nullopt, bool moves = false);
  // With an affine transform whose translation may be far from the origin.
  void addInstance(int mesh, int material, int node, const glm::dmat4& toWorld);

  int addCamera(Camera camera);
  void addLight(const PunctualLight& light);
  void addSun(const SunLamp& lamp);
  void addAmbient(const AmbientLamp& light);

 private:
  int addTexture(Texture texture);

  Scene& scene_;
  std::map<std::tuple<const TexelGrid*, bool, bool>, MipChain> chains_;  // by srgb, weightedByAlpha
};

// Adds the lamp to the scene, whose origin is at `origin` in world space. A disc becomes a
// single-sided emitting polygon of kDiscSides sides with exactly the area of the disc.
inline constexpr int kDiscSides = 128;
void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin);

}  // namespace chromeball

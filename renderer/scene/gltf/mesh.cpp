// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/parallel.h"
#include "scene/builder/complete_mesh.h"
#include "scene/extended_surface.h"
#include "scene/gltf/accessor.h"
#include "scene/mesh.h"

namespace chromeball {
namespace {

// The triangles of a vertex sequence, with the winding of the specification (glTF 2.0, 3.7.2.1).
std::vector<Triangle> assemble(const std::vector<uint32_t>& v, int mode) {
  std::vector<Triangle> triangles;
  if (v.size() < 3) return triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(v.size() / 3);
    for (size_t i = 0; i + 2 < v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
    return triangles;
  }
  triangles.reserve(v.size() - 2);
  for (size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      triangles.push_back({v[i + 1], v[i + 2], v[0]});
  }
  return triangles;
}

std::vector<Triangle> readAllTriangles(GltfFile& file, const tinygltf::Primitive& primitive,
                                       size_t vertexCount, const std::string& where) {
  const bool isIndexed = primitive.indices >= 0;
  const bool isList = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  std::vector<uint32_t> vertices;
  std::vector<Triangle> triangles;
  if (isIndexed && isList) {
    triangles = readTriangles(file, primitive.indices, vertexCount, where + ".indices");
  } else if (isIndexed) {
    vertices = readIndices(file, primitive.indices, vertexCount, where + ".indices");
  } else {
    vertices.resize(vertexCount);
    std::iota(vertices.begin(), vertices.end(), 0u);
  }
  if (!isIndexed || !isList) triangles = assemble(vertices, primitive.mode);
  const size_t count =
      isIndexed ? file.model.accessors[size_t(primitive.indices)].count : vertexCount;
  if (isList && !triangles.empty() && count % 3 != 0)
    file.warnOnce("ignored: indices after the last complete triangle");
  return triangles;
}

void checkFinite(const GltfFile& file, const std::vector<vec3>& positions,
                 const std::string& where) {
  if (areFinite(positions)) return;
  for (size_t i = 0; i < positions.size(); ++i)
    if (!isFinite(positions[i])) file.fail("{}: the position of vertex {} is not finite", where, i);
}

void readTextureCoordinates(GltfFile& file, AttributeReader& attributes, const Material& material,
                            Mesh& mesh) {
  for (const int set : uvSetsOf(material)) {
    if (int(mesh.uvs.size()) <= set) mesh.uvs.resize(size_t(set) + 1);
    const std::string name = fmt::format("TEXCOORD_{}", set);
    mesh.uvs[set] = attributes.read(name, readVectors<2>);
    if (!mesh.uvs[set].empty()) continue;
    file.warnOnce(fmt::format(
        "a primitive has no {}, which its material needs (textures, anisotropy); (0, 0) is used",
        name));
    mesh.uvs[set].assign(mesh.positions.size(), vec2(0));
  }
}

void readVertexColors(GltfFile& file, AttributeReader& attributes, const std::string& where,
                      Mesh& mesh) {
  mesh.colors = attributes.read("COLOR_0", readColors);
  for (vec4& c : mesh.colors) {
    if (!isFinite(Rgb(c)) || !std::isfinite(c.w))
      file.fail("{}.attributes.COLOR_0: a colour is not finite", where);
    c = glm::max(c, vec4(0));
  }
}

}  // namespace

bool isSkinned(const tinygltf::Primitive& primitive, const Pose& pose) {
  return !pose.joints.empty() && primitive.attributes.contains("JOINTS_0") &&
         primitive.attributes.contains("WEIGHTS_0");
}

bool hasTriangles(GltfFile& file, const tinygltf::Primitive& primitive, const std::string& where) {
  switch (primitive.mode) {
    case TINYGLTF_MODE_TRIANGLES:
    case TINYGLTF_MODE_TRIANGLE_STRIP:
    case TINYGLTF_MODE_TRIANGLE_FAN:
      if (primitive.attributes.contains("POSITION")) return true;
      file.warnOnce("ignored: primitives without POSITION");
      return false;
    case TINYGLTF_MODE_POINTS:
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
      file.warnOnce("ignored: points and lines");
      return false;
  }
  file.fail("{}.mode: {} is not in the range 0 to 6", where, primitive.mode);
}

MeshRecipe recipeOf(const tinygltf::Primitive& primitive, const Pose& pose,
                    const Material& material) {
  MeshRecipe recipe{
      .mode = primitive.mode,
      .indices = primitive.indices,
      .attributes = primitive.attributes,
      .targets = primitive.targets,
      .weights = {},
      .uvSets = {},
      .tangentSpace = {},
      .hasAlpha = material.alphaMode != AlphaMode::Opaque || passesStraight(material)};
  const auto weights = std::min(primitive.targets.size(), pose.weights.size());
  recipe.weights.assign(pose.weights.begin(), pose.weights.begin() + ptrdiff_t(weights));
  recipe.uvSets = uvSetsOf(material);
  if (const std::optional<TextureSlot> slot = tangentSpace(material)) {
    recipe.tangentSpace.push_back(uint32_t(slot->uvSet));
    for (const vec2& v : {slot->uvRow0, slot->uvRow1, slot->uvOffset})
      for (int k = 0; k < 2; ++k) recipe.tangentSpace.push_back(std::bit_cast<uint32_t>(v[k]));
  }
  return recipe;
}

std::optional<Mesh> readPrimitive(GltfFile& file, const tinygltf::Primitive& primitive,
                                  const Pose& pose, const std::string& where,
                                  const Material& material) {
  AttributeReader attributes(file, primitive.attributes, "vertices", where + ".attributes.");
  Mesh mesh;
  mesh.positions = attributes.read("POSITION", readVectors<3>);
  mesh.triangles = readAllTriangles(file, primitive, mesh.positions.size(), where);
  if (mesh.triangles.empty()) {
    file.warnOnce("ignored: primitives with fewer than three indices");
    return std::nullopt;
  }

  mesh.normals = attributes.read("NORMAL", readVectors<3>);
  if (tangentSpace(material) && !mesh.normals.empty())
    mesh.tangents = attributes.read("TANGENT", readVectors<4>);
  readTextureCoordinates(file, attributes, material, mesh);
  readVertexColors(file, attributes, where, mesh);

  applyMorphTargets(file, primitive, pose.weights, where, mesh);
  if (isSkinned(primitive, pose)) applySkin(file, primitive, pose.joints, where, mesh);
  checkFinite(file, mesh.positions, where);
  completeMesh(mesh, material);
  return mesh;
}

}  // namespace chromeball

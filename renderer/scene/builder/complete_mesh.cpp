// SPDX-License-Identifier: Apache-2.0
#include "scene/builder/complete_mesh.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace chromeball {
namespace {

template <class T>
void checkLength(const std::vector<T>& array, size_t vertices, const std::string& name) {
  if (!array.empty() && array.size() != vertices)
    throwInput("{}: {} elements for {} vertices", name, array.size(), vertices);
}

template <class T>
void checkFinite(const std::vector<T>& array, const std::string& name) {
  for (size_t i = 0; i < array.size(); ++i)
    for (int k = 0; k < T::length(); ++k)
      if (!std::isfinite(array[i][k])) throwInput("{}[{}]: is not finite", name, i);
}

void checkTriangles(const Mesh& mesh, const std::string& name) {
  const size_t vertices = mesh.positions.size();
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[i][k] >= vertices)
        throwInput("{}[{}]: there is no vertex {} among {}", name, i, mesh.triangles[i][k],
                   vertices);
}

bool hasSet(const Mesh& mesh, int set) {
  return size_t(set) < mesh.uvs.size() && !mesh.uvs[size_t(set)].empty();
}

std::set<int> setsOfTextures(const Material& material) {
  std::set<int> sets;
  Material copy = material;  // textureSlots() allows changes
  for (const TextureSlot* slot : textureSlots(copy))
    if (*slot) sets.insert(slot->uvSet);
  return sets;
}

void completeTangents(const Material& material, Mesh& mesh) {
  const std::optional<TextureSlot> slot = tangentSpace(material);
  if (!slot) return;
  if (mesh.normals.empty()) makeFlat(mesh);
  if (!mesh.tangents.empty()) return repairTangents(mesh);
  auto uv = longArray<vec2>(mesh.positions.size());
  if (hasSet(mesh, slot->uvSet))
    forIndices(uv.size(), 1,
               [&](size_t i) { uv[i] = slot->transform(mesh.uvs[size_t(slot->uvSet)][i]); });
  computeTangents(mesh, uv);
}

}  // namespace

std::vector<int> uvSetsOf(const Material& material) {
  std::set<int> sets = setsOfTextures(material);
  if (const std::optional<TextureSlot> slot = tangentSpace(material)) sets.insert(slot->uvSet);
  return {sets.begin(), sets.end()};
}

void checkShape(const Mesh& mesh, const std::string& location) {
  const size_t vertices = mesh.positions.size();
  checkTriangles(mesh, location + "triangles");
  checkLength(mesh.normals, vertices, location + "normals");
  checkLength(mesh.tangents, vertices, location + "tangents");
  checkLength(mesh.colors, vertices, location + "colors");
  for (size_t set = 0; set < mesh.uvs.size(); ++set)
    checkLength(mesh.uvs[set], vertices, fmt::format("{}uvs[{}]", location, set));
}

void checkMesh(const Mesh& mesh, const Material& material, const std::string& location) {
  const size_t vertices = mesh.positions.size();
  const auto named = [&](const std::string& array) { return location + array; };
  checkFinite(mesh.positions, named("positions"));
  checkShape(mesh, location);  // normals and tangents that are not finite are repaired
  checkFinite(mesh.colors, named("colors"));
  for (size_t i = 0; i < mesh.colors.size(); ++i)
    if (glm::any(glm::lessThan(mesh.colors[i], vec4(0))))
      throwInput("{}[{}]: is negative", named("colors"), i);
  for (size_t set = 0; set < mesh.uvs.size(); ++set)
    checkFinite(mesh.uvs[set], named(fmt::format("uvs[{}]", set)));
  for (const int set : setsOfTextures(material))
    if (vertices > 0 && !hasSet(mesh, set))
      throwInput("{}: is missing, which the material \"{}\" uses",
                 named(fmt::format("uvs[{}]", set)), material.name);
}

void completeMesh(Mesh& mesh, const Material& material) {
  if (std::ranges::all_of(mesh.colors, [](const vec4& c) { return c == vec4(1); }))
    mesh.colors.clear();
  dropUnusedVertices(mesh);
  repairNormals(mesh);
  completeTangents(material, mesh);
}

}  // namespace chromeball

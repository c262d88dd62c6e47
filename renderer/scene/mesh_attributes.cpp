// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_attributes.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "base/long_array.h"
#include "base/parallel.h"
#include "scene/linear_map.h"

namespace chromeball {
namespace {

using glm::dvec3;

template <class T>
void gather(std::vector<T>& array, const std::vector<uint32_t>& source) {
  if (array.empty()) return;
  auto gathered = longArray<T>(source.size());
  forRanges(source.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) gathered[i] = array[source[i]];
  });
  array = std::move(gathered);
}

// The triangle's normal times twice its area.
dvec3 areaNormal(const Mesh& mesh, const Triangle& t) {
  const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
  return glm::cross(b - a, c - a);
}

// Returns false if the vector is zero or not finite. Double precision keeps the length of tiny and
// huge float vectors from becoming 0 or infinite.
bool normalize(dvec3& v) {
  const double length = glm::length(v);
  if (!(length > 0) || !std::isfinite(length)) return false;
  v /= length;
  return true;
}

dvec3 anyPerpendicular(const dvec3& n) {
  const dvec3 axis = std::fabs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(n, axis));
}

// Transforms the normals and gives them unit length; those of no direction get that of the
// triangles around them.
void placeNormals(Mesh& mesh, const glm::dmat3& linear) {
  std::vector<uint32_t> bad;
  std::mutex adding;
  forRanges(mesh.normals.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      dvec3 n = linear * dvec3(mesh.normals[i]);
      if (normalize(n)) {
        mesh.normals[i] = vec3(n);
      } else {
        const std::lock_guard lock(adding);
        bad.push_back(uint32_t(i));
      }
    }
  });
  if (bad.empty()) return;

  std::vector<dvec3> around(mesh.normals.size(), dvec3(0));
  for (const Triangle& t : mesh.triangles) {
    const dvec3 n = areaNormal(mesh, t);
    for (int k = 0; k < 3; ++k) around[t[k]] += n;
  }
  for (uint32_t i : bad) mesh.normals[i] = normalize(around[i]) ? vec3(around[i]) : vec3(0, 1, 0);
}

template <class T, class Change>
void forEach(std::vector<T>& array, const Change& change) {
  forRanges(array.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) change(array[i]);
  });
}

}  // namespace

bool areFinite(const std::vector<vec3>& points) {
  std::atomic<bool> all = true;
  forRanges(points.size(), [&](size_t begin, size_t end) {
    if (!std::all_of(points.data() + begin, points.data() + end, isFinite)) all = false;
  });
  return all;
}

void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source) {
  gather(mesh.positions, source);
  gather(mesh.normals, source);
  gather(mesh.tangents, source);
  gather(mesh.colors, source);
  for (auto& uv : mesh.uvs) gather(uv, source);
}

void dropUnusedVertices(Mesh& mesh) {
  std::vector<uint8_t> isUsed(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) isUsed[t.x] = isUsed[t.y] = isUsed[t.z] = 1;
  if (std::ranges::find(isUsed, 0) == isUsed.end()) return;
  std::vector<uint32_t> source, newIndex(isUsed.size());
  for (uint32_t i = 0; i < isUsed.size(); ++i) {
    newIndex[i] = uint32_t(source.size());
    if (isUsed[i]) source.push_back(i);
  }
  gatherVertices(mesh, source);
  for (Triangle& t : mesh.triangles) t = {newIndex[t.x], newIndex[t.y], newIndex[t.z]};
}

void makeFlat(Mesh& mesh) {
  std::vector<uint32_t> source;
  source.reserve(3 * mesh.triangles.size());
  for (Triangle& t : mesh.triangles) {
    const uint32_t first = uint32_t(source.size());
    source.insert(source.end(), {t.x, t.y, t.z});
    t = {first, first + 1, first + 2};
  }
  gatherVertices(mesh, source);
  mesh.normals.assign(mesh.positions.size(), vec3(0));
  repairNormals(mesh);
}

void repairNormals(Mesh& mesh) { placeNormals(mesh, glm::dmat3(1)); }

void repairTangents(Mesh& mesh) {
  for (size_t i = 0; i < mesh.tangents.size(); ++i) {
    const vec4& given = mesh.tangents[i];
    dvec3 t(given);
    if (!normalize(t)) t = anyPerpendicular(dvec3(mesh.normals[i]));
    mesh.tangents[i] = vec4(vec3(t), given.w < 0 ? -1 : 1);
  }
}

void transformMesh(Mesh& mesh, const glm::dmat4& transform) {
  const glm::dmat3 linear(transform);
  const bool isMirrored = mirrors(linear);
  forEach(mesh.positions, [&](vec3& p) { p = vec3(transform * glm::dvec4(dvec3(p), 1)); });
  for (vec4& t : mesh.tangents) t = vec4(vec3(linear * dvec3(t)), isMirrored ? -t.w : t.w);
  if (isMirrored)
    for (Triangle& t : mesh.triangles) std::swap(t.y, t.z);
  placeNormals(mesh, normalMatrix(linear));
  repairTangents(mesh);
}

}  // namespace chromeball

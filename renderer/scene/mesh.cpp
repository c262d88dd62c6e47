// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "scene/motion.h"

namespace chromeball {

Mesh::Mesh() = default;
Mesh::Mesh(const Mesh&) = default;
Mesh::Mesh(Mesh&&) noexcept = default;
Mesh& Mesh::operator=(const Mesh&) = default;
Mesh& Mesh::operator=(Mesh&&) noexcept = default;
Mesh::~Mesh() = default;
bool Mesh::operator==(const Mesh&) const = default;

Mesh& MeshList::edit(size_t i) {
  const auto own = std::make_shared<Mesh>(*meshes_.at(i));
  meshes_[i] = own;
  return *own;
}

void MeshList::push_back(Mesh mesh) {
  meshes_.push_back(std::make_shared<const Mesh>(std::move(mesh)));
}

void MeshList::append(MeshList other) {
  meshes_.insert(meshes_.end(), other.meshes_.begin(), other.meshes_.end());
}

namespace {

using glm::dvec3;

template <class T>
void gather(std::vector<T>& array, const std::vector<uint32_t>& source) {
  if (array.empty()) return;
  auto gathered = longArray<T>(source.size());
  forIndices(source.size(), 1, [&](size_t i) { gathered[i] = array[source[i]]; });
  array = std::move(gathered);
}

// Replaces all vertex arrays: the new vertex i is a copy of the old vertex source[i]. Does not
// change the triangles.
void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source) {
  gather(mesh.positions, source);
  gather(mesh.normals, source);
  gather(mesh.tangents, source);
  gather(mesh.colors, source);
  for (auto& uv : mesh.uvs) gather(uv, source);
}

// The triangle's normal times twice its area.
dvec3 areaNormal(const Mesh& mesh, const Triangle& t) {
  const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
  return glm::cross(b - a, c - a);
}

// 0 if the vector is zero or not finite. Double precision keeps the length of tiny and huge float
// vectors from becoming 0 or infinite.
dvec3 directionOrZero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : dvec3(0);
}

vec3 directionOrUp(const dvec3& v) {
  const dvec3 direction = directionOrZero(v);
  return direction == dvec3(0) ? vec3(0, 1, 0) : vec3(direction);
}

dvec3 anyPerpendicular(const dvec3& n) {
  const dvec3 axis = std::fabs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(n, axis));
}

// Transforms the normals and gives them unit length; a normal without a direction gets the one of
// the triangles around it.
void placeNormals(Mesh& mesh, const glm::dmat3& linear) {
  std::vector<uint32_t> bad;
  std::mutex adding;
  forIndices(mesh.normals.size(), 1, [&](size_t i) {
    const dvec3 n = directionOrZero(linear * dvec3(mesh.normals[i]));
    if (n != dvec3(0)) {
      mesh.normals[i] = vec3(n);
    } else {
      const std::lock_guard lock(adding);
      bad.push_back(uint32_t(i));
    }
  });
  if (bad.empty()) return;

  std::vector<dvec3> around(mesh.normals.size(), dvec3(0));
  for (const Triangle& t : mesh.triangles) {
    const dvec3 n = areaNormal(mesh, t);
    for (int k = 0; k < 3; ++k) around[t[k]] += n;
  }
  for (uint32_t i : bad) mesh.normals[i] = directionOrUp(around[i]);
}

template <class T, class Change>
void forEach(std::vector<T>& array, const Change& change) {
  forIndices(array.size(), 1, [&](size_t i) { change(array[i]); });
}

}  // namespace

bool areFinite(const std::vector<vec3>& points) {
  std::atomic<bool> all = true;
  forRanges(points.size(), [&](size_t begin, size_t end) {
    if (!std::all_of(points.data() + begin, points.data() + end, isFinite)) all = false;
  });
  return all;
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
  const size_t count = mesh.triangles.size();
  auto source = longArray<uint32_t>(3 * count);
  forIndices(count, 1, [&](size_t i) {
    Triangle& t = mesh.triangles[i];
    const Triangle own(3 * i, 3 * i + 1, 3 * i + 2);
    for (int k = 0; k < 3; ++k) source[own[k]] = t[k];
    t = own;
  });
  gatherVertices(mesh, source);
  mesh.normals = longArray<vec3>(3 * count);
  forEach(mesh.triangles, [&](const Triangle& t) {
    mesh.normals[t.x] = mesh.normals[t.y] = mesh.normals[t.z] = directionOrUp(areaNormal(mesh, t));
  });
}

void repairNormals(Mesh& mesh) { placeNormals(mesh, glm::dmat3(1)); }

void repairTangents(Mesh& mesh) {
  forIndices(mesh.tangents.size(), 1, [&](size_t i) {
    const vec4& given = mesh.tangents[i];
    dvec3 t = directionOrZero(dvec3(given));
    if (t == dvec3(0)) t = anyPerpendicular(dvec3(mesh.normals[i]));
    mesh.tangents[i] = vec4(vec3(t), given.w < 0 ? -1 : 1);
  });
}

void transformMesh(Mesh& mesh, const glm::dmat4& transform) {
  const glm::dmat3 linear(transform);
  const bool isMirrored = mirrors(linear);
  forEach(mesh.positions, [&](vec3& p) { p = vec3(transform * glm::dvec4(dvec3(p), 1)); });
  forEach(mesh.tangents,
          [&](vec4& t) { t = vec4(vec3(linear * dvec3(t)), isMirrored ? -t.w : t.w); });
  if (isMirrored) forEach(mesh.triangles, [](Triangle& t) { std::swap(t.y, t.z); });
  placeNormals(mesh, normalMatrix(linear));
  repairTangents(mesh);
}

// Tangents for meshes without them. As in MikkTSpace, a vertex's tangent is the mean of dP/du over
// its triangles, each projected onto the plane of the vertex normal, normalised and weighted by the
// triangle's angle at the vertex; triangles whose UV coordinates turn opposite ways are not mixed.
// Unlike MikkTSpace, the indices of the file decide which triangles share a vertex: identical
// vertices with different indices are not merged, and triangles around a vertex are not grouped by
// shared edges.

namespace {

using glm::dvec2;
using glm::dvec3;

// The orientation of UV space in a triangle. Unlike handedness, which also depends on the side that
// a vertex normal is on, it is the same in all poses of a mesh: these are split alike.
enum Winding { kClockwise = 0, kCounter = 1, kUndefined = 2 };  // as (x, y); no area

double cornerAngle(const std::array<dvec3, 3>& p, int k) {
  const dvec3 a = directionOrZero(p[(k + 1) % 3] - p[k]),
              b = directionOrZero(p[(k + 2) % 3] - p[k]);
  return std::acos(std::fmin(std::fmax(glm::dot(a, b), -1.0), 1.0));
}

// The contributions of a triangle to the frames of its three corners.
struct Contribution {
  Winding winding = kUndefined;
  std::array<dvec3, 3> tangent{};      // along dP/du; its length is the corner's angle
  std::array<double, 3> handedness{};  // with the same weight; positive: right-handed
};

Contribution contributionOf(const Mesh& mesh, const std::vector<vec2>& uv, const Triangle& t) {
  const std::array<dvec3, 3> p{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
  const dvec2 d1 = dvec2(uv[t.y]) - dvec2(uv[t.x]), d2 = dvec2(uv[t.z]) - dvec2(uv[t.x]);
  const double area = d1.x * d2.y - d2.x * d1.y;  // twice the signed area in UV space
  Contribution c;
  if (!(std::fabs(area) > 0) || !std::isfinite(area)) return c;
  c.winding = area < 0 ? kClockwise : kCounter;

  const dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  const dvec3 alongU = (e1 * d2.y - e2 * d1.y) * (area < 0 ? -1.0 : 1.0);  // dP/du, any length
  const dvec3 front = glm::cross(e1, e2);
  for (int k = 0; k < 3; ++k) {
    const dvec3 n = mesh.normals[t[k]];
    const double angle = cornerAngle(p, k);
    c.tangent[k] = directionOrZero(alongU - n * glm::dot(n, alongU)) * angle;
    // A normal map's +Y points up in the image, against v.
    const bool isRight = (area < 0) == (glm::dot(front, n) >= 0);
    c.handedness[k] = isRight ? angle : -angle;
  }
  return c;
}

// The sums of the contributions to a vertex by triangles of one winding.
struct VertexFrame {
  dvec3 tangent{0};
  double handedness = 0;
  bool isUsed = false;

  void add(const Contribution& c, size_t corner) {
    tangent += c.tangent[corner];
    handedness += c.handedness[corner];
    isUsed = true;
  }
};

constexpr size_t kTrianglesAtOnce = 1 << 14;  // in some milliseconds

}  // namespace

void computeTangents(Mesh& mesh, const std::vector<vec2>& uv) {
  const size_t vertexCount = mesh.positions.size();
  auto frames = longArray<std::array<VertexFrame, 2>>(vertexCount);
  std::vector<Winding> windings;
  windings.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    if (windings.size() % kTrianglesAtOnce == 0) endIfCancelled();
    const Contribution c = contributionOf(mesh, uv, t);
    windings.push_back(c.winding);
    if (c.winding == kUndefined) continue;
    for (int k = 0; k < 3; ++k) frames[t[k]][c.winding].add(c, size_t(k));
  }

  // If a vertex has triangles of both kinds, the counter-clockwise ones get a copy of the vertex.
  std::vector<uint32_t> source(vertexCount), copy(vertexCount);
  for (uint32_t i = 0; i < vertexCount; ++i) source[i] = copy[i] = i;
  for (uint32_t i = 0; i < vertexCount; ++i) {
    if (i % kTrianglesAtOnce == 0) endIfCancelled();
    if (!frames[i][kClockwise].isUsed || !frames[i][kCounter].isUsed) continue;
    copy[i] = uint32_t(source.size());
    source.push_back(i);
  }
  forIndices(mesh.triangles.size(), 1, [&](size_t i) {
    if (windings[i] == kCounter)
      for (int k = 0; k < 3; ++k) mesh.triangles[i][k] = copy[mesh.triangles[i][k]];
  });
  gatherVertices(mesh, source);

  mesh.tangents = longArray<vec4>(source.size());
  for (uint32_t i = 0; i < source.size(); ++i) {
    if (i % kTrianglesAtOnce == 0) endIfCancelled();
    const std::array<VertexFrame, 2>& both = frames[source[i]];
    const VertexFrame& frame =
        both[i >= vertexCount || !both[kClockwise].isUsed ? kCounter : kClockwise];
    mesh.tangents[i] = vec4(vec3(directionOrZero(frame.tangent)), frame.handedness < 0 ? -1 : 1);
  }
  repairTangents(mesh);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "bake/placed_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace chromeball {
namespace {

// For each vertex, the first one at the same position.
std::vector<uint32_t> welded(const std::vector<glm::dvec3>& positions) {
  std::vector<uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t i) {
    const glm::dvec3& p = positions[i];
    return std::tuple(p.x, p.y, p.z);
  };
  std::ranges::sort(
      order, [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  for (size_t i = 0; i < order.size(); ++i)
    first[order[i]] =
        i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

struct Edge {
  uint32_t from, to;  // from < to
  uint32_t triangle;
  int side;
  bool forward;

  auto key() const { return std::pair(from, to); }
};

std::vector<std::array<uint32_t, 3>> findNeighbours(const PlacedMesh& placed) {
  const std::vector<uint32_t> first = welded(placed.positions);
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < placed.triangleCount(); ++i)
    for (int side = 0; side < 3 && placed.hasArea(i); ++side) {
      const uint32_t a = first[placed.triangle(i)[side]];
      const uint32_t b = first[placed.triangle(i)[(side + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), i, side, a < b});
    }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tuple(a.key(), a.triangle) < std::tuple(b.key(), b.triangle);
  });
  std::vector<std::array<uint32_t, 3>> neighbours(
      placed.triangleCount(), {PlacedMesh::kNone, PlacedMesh::kNone, PlacedMesh::kNone});
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key() == edges[begin].key()) ++end;
    const Edge &a = edges[begin], &b = edges[end - 1];
    if (end - begin != 2 || a.forward == b.forward) continue;
    neighbours[a.triangle][size_t(a.side)] = b.triangle;
    neighbours[b.triangle][size_t(b.side)] = a.triangle;
  }
  return neighbours;
}

// Connected triangles are closed together.
std::vector<uint8_t> findClosed(const PlacedMesh& placed) {
  std::vector<uint8_t> isClosed(placed.triangleCount()), isSeen(placed.triangleCount());
  std::vector<uint32_t> part;
  for (uint32_t seed = 0; seed < placed.triangleCount(); ++seed) {
    if (isSeen[seed] || !placed.hasArea(seed)) continue;
    part.assign(1, seed);
    isSeen[seed] = 1;
    bool closed = true;
    for (size_t i = 0; i < part.size(); ++i)
      for (const uint32_t neighbour : placed.neighbours[part[i]]) {
        closed &= neighbour != PlacedMesh::kNone;
        if (neighbour == PlacedMesh::kNone || isSeen[neighbour]) continue;
        isSeen[neighbour] = 1;
        part.push_back(neighbour);
      }
    for (const uint32_t triangle : part) isClosed[triangle] = closed;
  }
  return isClosed;
}

}  // namespace

PlacedMesh::PlacedMesh(const Scene& scene, int index) : instance(index) {
  const Instance& placed = scene.instances[size_t(index)];
  mesh = &scene.meshes[size_t(placed.mesh)];
  const glm::mat3 linear = placed.toWorld ? placed.toWorld->linear : glm::mat3(1);
  mirrored = placed.mirrors();
  for (const vec3& p : mesh->positions) positions.push_back(placed.point(p));
  // Normals are transformed by the cofactor matrix.
  const glm::mat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
  for (const vec3& n : mesh->normals) {
    const vec3 turned = (mirrored ? -1.0f : 1.0f) * (cofactors * n);
    const float length = glm::length(turned);
    shadingNormals.push_back(length > 0 ? turned / length : vec3(0));
  }
  for (const vec4& t : mesh->tangents) {
    const vec3 turned = linear * vec3(t);
    const float length = glm::length(turned);
    tangents.emplace_back(length > 0 ? turned / length : vec3(1, 0, 0), mirrored ? -t.w : t.w);
  }
  for (const Triangle& t : mesh->triangles) {
    const glm::dvec3 a = positions[t.x];
    const glm::dvec3 normal = glm::cross(positions[t.y] - a, positions[t.z] - a);
    const double length = glm::length(normal);
    const bool valid = length > 0 && std::isfinite(length);
    areas.push_back(valid ? length / 2 : 0);
    normals.push_back(valid ? (mirrored ? -normal : normal) / length : glm::dvec3(0));
  }
  neighbours = findNeighbours(*this);
  isClosed = findClosed(*this);
}

std::vector<PlacedMesh> placedMeshes(const Scene& scene) {
  std::vector<PlacedMesh> meshes;
  meshes.reserve(scene.instances.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) meshes.emplace_back(scene, int(i));
  return meshes;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The triangles of an instance at their places in the scene, and their shared edges.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

struct PlacedMesh {
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  int instance = 0;
  const Mesh* mesh = nullptr;
  bool mirrored = false;  // the instance turns triangles around: clockwise from the front
  std::vector<glm::dvec3> positions;
  std::vector<vec3> shadingNormals;  // by vertex, unit; empty: flat
  // By vertex, unit, with the sign of the bitangent; empty: without normal map.
  std::vector<vec4> tangents;
  std::vector<glm::dvec3> normals;  // by triangle, unit, on the front; 0 for one without an area
  std::vector<double> areas;        // by triangle, m^2
  // For each triangle, the triangles beyond its edges 0-1, 1-2 and 2-0. Vertices at the same
  // position count as one; an edge of three triangles or more joins none.
  std::vector<std::array<uint32_t, 3>> neighbours;
  // For each triangle, whether it is part of a closed surface, whose back only the inside sees.
  std::vector<uint8_t> isClosed;

  // `scene` must outlive this.
  PlacedMesh(const Scene& scene, int index);

  const Triangle& triangle(uint32_t i) const { return mesh->triangles[i]; }
  size_t triangleCount() const { return mesh->triangles.size(); }
  bool hasArea(uint32_t i) const { return areas[i] > 0; }
  // The shading normal at a corner of a triangle, 0 to 2.
  glm::dvec3 shadingNormal(uint32_t i, int corner) const {
    return shadingNormals.empty() ? normals[i] : glm::dvec3(shadingNormals[triangle(i)[corner]]);
  }
};

std::vector<PlacedMesh> placedMeshes(const Scene& scene);

struct NamedArray {
  std::string name;
  std::vector<vec3> elements;
};

// An instance with vertices of its own, in the scene's coordinates.
struct BakedGeometry {
  const PlacedMesh* placed;
  std::vector<uint32_t> vertices;      // of the mesh
  std::vector<Triangle> triangles;     // counter-clockwise from the front
  std::vector<vec2> lightmapUv;        // v down; empty: none
  std::vector<vec4> colors;            // linear; empty: the mesh's own
  std::vector<vec3> light;             // the baked light, linear and unscaled; empty: none
  std::vector<NamedArray> attributes;  // more of the vertices

  explicit BakedGeometry(const PlacedMesh& source) : placed(&source) {}

  // Turns the triangle around if the instance is mirrored.
  void add(const Triangle& t) {
    triangles.push_back(placed->mirrored ? Triangle(t.x, t.z, t.y) : t);
  }
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The geometry of a baked model.
#pragma once

#include <string>

#include "bake/placed_mesh.h"

namespace chromeball {

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
  std::vector<vec4> colors;            // linear; empty: those of the mesh
  std::vector<vec3> light;             // what was baked, linear and unscaled; empty: none
  std::vector<NamedArray> attributes;  // more of the vertices

  explicit BakedGeometry(const PlacedMesh& source) : placed(&source) {}

  // Turns the triangle around if the instance is mirrored.
  void add(const Triangle& t) {
    triangles.push_back(placed->mirrored ? Triangle(t.x, t.z, t.y) : t);
  }
};

}  // namespace chromeball

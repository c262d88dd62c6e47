// SPDX-License-Identifier: Apache-2.0
// Transfer matrices of surfaces of any material: from a basis of light to the radiance in each of a
// set of directions (Sloan, Kautz and Snyder 2002, section 6; Liu et al. 2004).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"
#include "relight/transfer/vertex_transfer.h"

namespace chromeball {

// Directions of view above a surface, between which radiance is interpolated.

// The hemisphere about +z as a square of kSize x kSize nodes, by the octahedral map (Cigolle et al.
// 2014: "A Survey of Efficient Representations for Independent Unit Vectors", section 3.2): no node
// is on the horizon.
class ViewGrid {
 public:
  static constexpr int kSize = 5, kCount = kSize * kSize;

  static vec3 direction(int node) {
    const float u = (float(node % kSize) + 0.5f) / kSize, v = (float(node / kSize) + 0.5f) / kSize;
    const float x = u + v - 1, y = u - v;
    return glm::normalize(vec3(x, y, 1 - std::fabs(x) - std::fabs(y)));
  }

  // Bilinear, with sum 1: of the four nodes about a unit direction; that of one below the horizon
  // is raised to it.
  struct Weights {
    std::array<int, 4> nodes;
    std::array<float, 4> weights;
  };
  static Weights at(const vec3& d) {
    const float length = std::fabs(d.x) + std::fabs(d.y) + std::max(d.z, 0.0f);
    const float x = length > 0 ? d.x / length : 0, y = length > 0 ? d.y / length : 0;
    const auto [column, right] = place((x + y + 1) / 2);
    const auto [row, below] = place((x - y + 1) / 2);
    const int first = row * kSize + column;
    return {{first, first + 1, first + kSize, first + kSize + 1},
            {(1 - right) * (1 - below), right * (1 - below), (1 - right) * below, right * below}};
  }

 private:
  struct Place {
    int index;
    float fraction;  // of the next index
  };
  static Place place(float position) {
    if (!(position > 0)) return {0, 0};  // a file's frame may be degenerate
    const float at = std::clamp(position * kSize - 0.5f, 0.0f, float(kSize - 1));
    const int index = std::min(int(at), kSize - 2);
    return {index, at - float(index)};
  }
};

struct GlossyTransfer {
  // Of each point: for each node of the grid, the radiance towards it per unit of each function
  // and, last, what the scene's own lamps and emission make. count is
  // ViewGrid::kCount (functions + 1).
  VertexTransfer matrices;
  std::vector<vec3> normals;  // by point: +z of its grid, in the frame Frame(normal)
};

// Of the front of each surface, with its own material. `settings.samples`: paths for each node.
// The rest as estimateTransfer().
GlossyTransfer estimateGlossyTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                      const std::vector<BakePoint>& points, const LightBasis& basis,
                                      const TransferSettings& settings, const Progress& progress);

}  // namespace chromeball

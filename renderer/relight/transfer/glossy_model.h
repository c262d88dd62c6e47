// SPDX-License-Identifier: Apache-2.0
// A model that carries compressed transfer matrices, to be lit by any probe and seen from a point
// (Liu et al. 2004; HDRI book, section 9.9.2, figure 9.46 d).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"
#include "relight/transfer/clustered_pca.h"
#include "relight/transfer/transfer_model.h"

namespace chromeball {

// Transfer matrices of surfaces of any material, from a basis of light to the radiance in each of a
// set of directions (Sloan, Kautz and Snyder 2002, section 6; Liu et al. 2004).

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

  // Bilinear weights, with sum 1, of the four nodes around a unit direction; a direction below the
  // horizon is raised to it.
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
  // For each point and each node of the grid, the radiance towards it per unit of each function
  // and, last, the radiance from the scene's own lamps and emission. The count is ViewGrid::kCount
  // (functions + 1).
  VertexTransfer matrices;
  std::vector<vec3> normals;  // by point: +z of its grid, in the frame Frame(normal)
};

// Estimates the glossy transfer of the front of each surface, with its own material.
// `settings.samples`: paths for each node. For the rest see estimateTransfer().
GlossyTransfer estimateGlossyTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                      const std::vector<BakePoint>& points, const LightBasis& basis,
                                      const TransferSettings& settings, const Progress& progress);

// The matrices, one signal each, of the points that are not inside a body, in their order. The
// scene's own light is scaled, by a power of two, to be as strong as the mean function: else the
// unit of radiance would decide what a compression keeps.
Signals signalsOf(const GlossyTransfer& transfer);

struct GlossyFile {
  // The geometry of each instance, with the attributes
  //   _PRT_NORMAL       +z of the vertex's grid
  //   _PRT_0, _PRT_1..  (cluster, weight 0, weight 1), (weight 2, ...): three numbers each, as
  //                     many weights as the most of a cluster, else 0. Cluster -1: inside a body.
  std::vector<BakedGeometry> geometry;
  // mean, vector0, vector1, ...: matrices of all clusters one after the other, RGB; 0 where a
  // cluster has less vectors.
  std::vector<NamedArray> tables;
};
GlossyFile glossyFile(const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                      const GlossyTransfer& transfer, const ClusteredPca& pca);

bool isGlossy(const TransferFile& file);

// The radiance towards `eye` (in the scene's coordinates) of points of the file's vertices, as in
// lightOf(). The light multiplies the clusters' few matrices once; a vertex is a sum of its weights
// (Sloan et al. 2003, eq. 7).
TransferLight lightTowards(const TransferFile& file, const std::vector<PlacedMesh>& meshes,
                           const std::vector<BakePoint>& points, std::span<const Rgb> light,
                           const glm::dvec3& eye);

}  // namespace chromeball

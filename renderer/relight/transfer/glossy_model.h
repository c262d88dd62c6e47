// SPDX-License-Identifier: Apache-2.0
// A model that carries compressed transfer matrices, to be lit by any probe and seen from a point
// (Liu et al. 2004; HDRI book, section 9.9.2, figure 9.46 d).
#pragma once

#include "relight/transfer/clustered_pca.h"
#include "relight/transfer/glossy_transfer.h"
#include "relight/transfer/transfer_model.h"

namespace chromeball {

// Of the points that are not inside a body, in their order: matrices as one signal each.
Signals signalsOf(const GlossyTransfer& transfer);

struct GlossyFile {
  // By instance, with the attributes
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

// Radiance towards `eye` (the scene's coordinates) of points of the file's vertices, as lightOf().
// The light multiplies the clusters' few matrices once; a vertex is a sum of its weights (Sloan et
// al. 2003, eq. 7).
TransferLight lightTowards(const TransferFile& file, const std::vector<PlacedMesh>& meshes,
                           const std::vector<BakePoint>& points, std::span<const Rgb> light,
                           const glm::dvec3& eye);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Transfer matrices of surfaces of any material: from a basis of light to the radiance in each of a
// set of directions (Sloan, Kautz and Snyder 2002, section 6; Liu et al. 2004).
#pragma once

#include "relight/vertex_transfer.h"
#include "relight/view_grid.h"

namespace chromeball {

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

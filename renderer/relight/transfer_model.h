// SPDX-License-Identifier: Apache-2.0
// A model that carries its transfer, to be lit by any probe and seen from any side (HDRI book,
// section 9.9.2, figure 9.46).
#pragma once

#include "bake/bake.h"
#include "bake/baked_geometry.h"
#include "relight/transfer_file.h"
#include "relight/vertex_transfer.h"

namespace chromeball {

// By instance, in the order of vertexPoints(), with the attributes _PRT_0, _PRT_1, ... (values of
// estimateTransfer(): irradiance / pi per function of the basis, RGB) and _PRT_OWN (light of the
// scene's own lamps), if there is any. Vertices inside of bodies take the mean of their neighbours.
std::vector<BakedGeometry> transferGeometry(const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const VertexTransfer& transfer);

struct TransferLight {
  BakeResult light;
  size_t negative = 0;  // points where a channel was below 0, which is raised to 0
};

// Irradiance, W/m^2, at points of the file's vertices under light with these coefficients
// (LightBasis::project()): pi times the sum of l_k _PRT_k, and _PRT_OWN. It does not depend on the
// viewer. Throws InputError if the file has not all of them.
TransferLight lightOf(const TransferFile& file, const std::vector<BakePoint>& points,
                      std::span<const Rgb> light);

// Adds a point of this light.
void addPoint(TransferLight& all, const dvec3& light);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Baked light as colours of vertices.
#pragma once

#include "bake/bake.h"
#include "bake/bake_points.h"
#include "bake/placed_mesh.h"

namespace chromeball {

// The geometry of each instance, its vertices in the order of vertexPoints(). BakedGeometry::colors
// are linear, not scaled:
//   irradiance         the mesh's colours x E / pi; shownColor() if showsWhole()
//   ambient occlusion  the mesh's colours x the fraction of the sky
//   radiance           shownColor()
// Vertices inside of bodies take the mean of their neighbours.
std::vector<BakedGeometry> colouredGeometry(const PointLight& what,
                                            const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const BakeResult& baked);

// The largest channel of the colours that count for the scale (baked_file.h).
float brightestOf(const PointLight& what, const std::vector<BakedGeometry>& geometry);

// Whether a surface's colours are all that it shows: its texture does not come on top.
bool showsWhole(BakedLight what, const Material& material);

// The geometry of each instance: its vertices, in the order of vertexPoints(), and the triangles
// between them.
std::vector<BakedGeometry> vertexGeometry(const std::vector<PlacedMesh>& meshes,
                                          const std::vector<BakePoint>& points);

// Fills an instance's vertices without light with the mean of those that they share edges with,
// from the edge of the lit part inwards.
void fillVertices(const std::vector<Triangle>& triangles, std::vector<Rgb>& light,
                  std::vector<uint8_t> isLit);

}  // namespace chromeball

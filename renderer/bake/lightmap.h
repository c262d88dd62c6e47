// SPDX-License-Identifier: Apache-2.0
// The pages of an atlas, and the model that shows them.
#pragma once

#include "bake/bake.h"
#include "bake/placed_mesh.h"
#include "image/image.h"

namespace chromeball {

struct Lightmap {
  Image light;          // RGB, linear: W/m^2, a fraction of the sky, or radiance
  Image shown;          // RGBA, linear: shownColor()
  float brightest = 0;  // channel of the colours that count for the scale
};

// `light`: of each point, filtered or not; buried ones take that of their neighbours.
Lightmap makeLightmap(const PointLight& what, const std::vector<BakePoint>& points,
                      const BakeResult& baked, const std::vector<Rgb>& light, const Atlas& atlas);

// By instance: a vertex for each chart that a vertex of the mesh is in.
std::vector<BakedGeometry> lightmappedGeometry(const std::vector<PlacedMesh>& meshes,
                                               const std::vector<Chart>& charts,
                                               const Atlas& atlas);

}  // namespace chromeball

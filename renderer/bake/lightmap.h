// SPDX-License-Identifier: Apache-2.0
// The pages of an atlas, and the model that shows them.
#pragma once

#include "bake/atlas.h"
#include "bake/bake.h"
#include "bake/placed_mesh.h"
#include "image/image.h"

namespace chromeball {

struct Lightmap {
  Image light;          // RGB, linear: W/m^2, a fraction of the sky, or radiance
  Image shown;          // RGBA, linear: shownColor()
  float brightest = 0;  // channel of the colours that count for the scale
};

// `light`: each point's, filtered or not; buried points take their neighbours' light.
Lightmap makeLightmap(const PointLight& what, const std::vector<BakePoint>& points,
                      const BakeResult& baked, const std::vector<Rgb>& light, const Atlas& atlas);

// The geometry of each instance, with a vertex for each chart that a vertex of the mesh is in.
std::vector<BakedGeometry> lightmappedGeometry(const std::vector<PlacedMesh>& meshes,
                                               const std::vector<Chart>& charts,
                                               const Atlas& atlas);

// The light of each point, filtered by nonlocal means (Rousselle et al. 2012): each half of the
// samples is averaged over the texels of the same chart whose surroundings are alike in the other
// half, up to the noise of both. Constant light stays the same to the last bit. Buried points take
// no part. `points`: the texels of a page of this size.
std::vector<Rgb> filteredLight(const std::vector<BakePoint>& points, const BakeResult& baked,
                               int size);

// Within the place of each chart, fills texels ring by ring with the mean of their filled
// neighbours, so that filtering across the edge of a chart, and around points inside of bodies,
// sees the chart's own light. A place without any light is black; the rest of the page has the mean
// of its light. `isBaked`: by texel.
void fillPage(Image& page, std::vector<uint8_t> isBaked, const Atlas& atlas);

}  // namespace chromeball

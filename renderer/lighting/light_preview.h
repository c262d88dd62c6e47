// SPDX-License-Identifier: Apache-2.0
// An image of a probe with the directional lights that replace it, for `lights --preview`.
#pragma once

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "lighting/constellation/partition.h"

namespace chromeball {

// What each light of a constellation stands for: regions of the map, or the tiling whose corners
// are lights.
struct LightRegions {
  Partition partition;
  std::vector<MapLine> tiling;
};

// The lat-long map, tone mapped to display-linear colours, 1024 x 512, with a white dot at each
// light.
Image lightPreview(const Image& latLong, const Constellation& lights);

// The same with red dots, and with white outlines of the regions, one pixel wide with a black edge
// (Madsen and Laursen 2007, Fig. 1; HDRI book, Figs. 9.32 and 9.35). The partition, if any, is of
// `latLong`.
Image lightPreview(const Image& latLong, const Constellation& lights, const LightRegions& regions);

}  // namespace chromeball

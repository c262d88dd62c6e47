// SPDX-License-Identifier: Apache-2.0
// The places of charts on a square page of texels.
#pragma once

#include <vector>

#include "bake/charts.h"

namespace chromeball {

inline constexpr int kMaxPage = 16384;  // texels along an edge

// A chart's texels with the padding around them.
struct AtlasPlace {
  int x, y, width, height;
};

struct Atlas {
  int size = 0;        // of the page, in texels
  int padding = 0;     // texels around each chart
  double density = 0;  // texels per metre
  std::vector<AtlasPlace> places;

  // The texel coordinates of a point of a chart. The edges of its rectangle go through the centres
  // of texels, so that bilinear filtering within the chart reads no other texels.
  glm::dvec2 toPage(size_t chart, const glm::dvec2& point) const {
    const AtlasPlace& place = places[chart];
    return glm::dvec2(place.x + padding, place.y + padding) + 0.5 + density * point;
  }
};

// The highest density, up to a factor of 1.001, of a page of a given size. Throws InputError, begun
// by `location`, if the charts do not fit at any density.
Atlas fitAtlas(const std::vector<Chart>& charts, int size, int padding,
               const std::string& location);

// The smallest page, whose size is a power of two, for texels of this many metres. Throws
// InputError, begun by `location`, if it would have more than kMaxPage texels.
Atlas atlasOfTexels(const std::vector<Chart>& charts, double metres, int padding,
                    const std::string& location);

}  // namespace chromeball

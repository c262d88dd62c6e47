// SPDX-License-Identifier: Apache-2.0
// Windows and lamps of a probe as polygons of constant radiance (HDRI book, section 9.6.1, Figs.
// 9.29 and 9.30).
#pragma once

#include <array>
#include <vector>

#include "image/image.h"
#include "math/spherical_polygon.h"

namespace chromeball {

struct PolygonSource {
  SphericalPolygon polygon;
  dvec3 radiance;
  double coveredTexels = 0;      // of the map; 0: smaller than a texel, or between points of them
  std::array<dvec3, 3> taken{};  // vector irradiance of each channel of what the map had there

  // One directional light in its place: unit, that of the luminance taken; W/m^2 on a surface
  // facing it.
  dvec3 direction() const;
  dvec3 irradiance() const;

  // By how much constant radiance changes the irradiance of surfaces that see all of it, at most:
  // |vector irradiance - taken| / |taken| in luminance. 0 of even radiance.
  double unevenness() const;
};

// The sources, and the map without them. From each texel the part that a polygon covers gives up
// its radiance above `fill`, the mean of the texels around the polygon, channel by channel. The
// source's radiance is what was taken, by radiance x solid angle, over the polygon's solid angle,
// so that energy is kept; texels below `fill` stay. Polygons are taken one after another.
struct PolygonExtraction {
  std::vector<PolygonSource> sources;  // in the order of the polygons
  Image remainder;                     // of the map's size, three channels
};
PolygonExtraction extractPolygons(const Image& latLong,
                                  const std::vector<SphericalPolygon>& polygons);

// Proposals: convex polygons around the connected regions whose luminance is above 4 times the mean
// of the sphere, at most `count`, in order of decreasing flux; without regions that reach more than
// 60 degrees from their middle. While there are fewer, regions of uneven radiance are cut in two,
// through the middle of their flux and across their longer side, those of most flux first.
std::vector<SphericalPolygon> suggestPolygons(const Image& latLong, int count);

}  // namespace chromeball

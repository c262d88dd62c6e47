// SPDX-License-Identifier: Apache-2.0
// Windows and lamps of a probe as polygons of constant radiance (HDRI book, section 9.6.1, Figs.
// 9.29 and 9.30).
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/polygon.h"
#include "probe/load.h"

namespace chromeball {

struct PolygonSource {
  SphericalPolygon polygon;
  dvec3 radiance;
  double coveredTexels = 0;      // of the map; 0: smaller than a texel, or between points of them
  std::array<dvec3, 3> taken{};  // vector irradiance of the light taken from the map, by channel

  // The source as one directional light: the unit direction of the luminance taken, and the
  // irradiance in W/m^2 of a surface that faces it.
  dvec3 direction() const;
  dvec3 irradiance() const;
};

// How far the sources' constant radiances are from what was taken: |sum of (vector irradiance -
// taken)| / sum of |taken| in the channel where it is largest; 0 for even radiance. A surface that
// sees all sources gains or loses up to this fraction of the irradiance of one that faces them.
double unevenness(std::span<const PolygonSource> sources);

// The source that a polygon alone would become.
PolygonSource sourceOf(const Image& latLong, const SphericalPolygon& polygon);

// The sources, and the map without them. From each texel the part that a polygon covers gives up
// its radiance above `fill`, the mean of the texels around the polygon, channel by channel. The
// source's radiance is the sum of radiance x solid angle taken, divided by the polygon's solid
// angle, so that energy is kept; texels below `fill` stay. Polygons are taken one after another.
struct PolygonExtraction {
  std::vector<PolygonSource> sources;  // in the order of the polygons
  Image remainder;                     // of the map's size, three channels
};
PolygonExtraction extractPolygons(const Image& latLong,
                                  const std::vector<SphericalPolygon>& polygons);

// Polygons of a probe by their corners in its image.

using PolygonCorners = std::vector<glm::dvec2>;  // pixels of the probe's image, from its top left

// The polygon with these corners in the image of a probe's file, with great circles as edges.
// Throws InputError, which starts with `location`.
SphericalPolygon polygonOf(const PolygonCorners& corners, const LoadedProbe& probe,
                           const std::string& location);
// The corners in that image.
PolygonCorners cornersOf(const SphericalPolygon& polygon, const LoadedProbe& probe);

// Proposes the polygons of windows and lamps in a probe, for [[source]].

// Proposals: convex polygons around the connected regions whose luminance is above 4 times the mean
// of the sphere, at most `count`, in order of decreasing flux; without regions that reach more than
// 60 degrees from their middle. Where the uneven part of a region's flux is more than the flux of
// the next region, the former is cut in two instead, through the centre of its flux and across the
// direction in which the flux is spread most.
std::vector<SphericalPolygon> suggestPolygons(const Image& latLong, int count);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/polygon_corners.h"

#include "base/error.h"

namespace chromeball {
namespace {

// Between positions in the file and in the map, for a map that was turned by 180 degrees on
// loading.
glm::dvec2 turned(const glm::dvec2& uv, const LoadedProbe& probe) {
  if (!probe.turned) return uv;
  return {uv.x < 0.5 ? uv.x + 0.5 : uv.x - 0.5, uv.y};
}

}  // namespace

SphericalPolygon polygonOf(const PolygonCorners& corners, const LoadedProbe& probe,
                           const std::string& location) {
  std::vector<dvec3> directions;
  for (const glm::dvec2& corner : corners) {
    const glm::dvec2 uv = corner / glm::dvec2(probe.fileWidth, probe.fileHeight);
    const bool isInside = uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1;
    const auto direction =
        isInside ? uvToDirection(probe.mapping, turned(uv, probe)) : std::nullopt;
    if (!direction)
      throwInput("{}: ({:g}, {:g}) is no pixel of the probe, whose image is {} x {}", location,
                 corner.x, corner.y, probe.fileWidth, probe.fileHeight);
    directions.push_back(*direction);
  }
  return {directions, location};
}

PolygonCorners cornersOf(const SphericalPolygon& polygon, const LoadedProbe& probe) {
  PolygonCorners corners;
  for (const dvec3& direction : polygon.corners()) {
    const glm::dvec2 uv = turned(directionToUv(probe.mapping, direction), probe);
    corners.push_back(uv * glm::dvec2(probe.fileWidth, probe.fileHeight));
  }
  return corners;
}

}  // namespace chromeball

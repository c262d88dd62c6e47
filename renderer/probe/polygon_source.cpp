// SPDX-License-Identifier: Apache-2.0
#include "probe/polygon_source.h"

#include <iterator>

#include "base/error.h"
#include "base/parallel.h"
#include "probe/mapping.h"
#include "probe/sun_extraction.h"

namespace chromeball {
namespace {

struct CoveredTexel {
  Texel texel;
  float part;  // of its area, above 0
};

// Columns of a row, which may begin left of the map or end right of it.
struct Columns {
  int begin, end;
};

// The columns of a lat-long map that a cap may touch, in row y. At an elevation closer to a pole
// than the cap's rim, all columns; else those between the meridians that touch the cap,
// asin(sin(radius) / cos(elevation)) from its axis.
Columns columnsOf(const SphericalPolygon& polygon, const ImageSize& size) {
  const double radius = polygon.capRadius(),
               cosine = std::hypot(polygon.axis().x, polygon.axis().z);
  if (std::sin(radius) >= cosine) return {0, size.width};
  const double half = std::asin(std::sin(radius) / cosine) / (2 * kPiD) * size.width;
  const double centre = directionToUv(Mapping::LatLong, polygon.axis()).x * size.width;
  const Columns columns{int(std::floor(centre - half)) - 1, int(std::ceil(centre + half)) + 1};
  return columns.end - columns.begin < size.width ? columns : Columns{0, size.width};
}

// The texels of a lat-long map that the polygon covers in part or whole, by 4 x 4 points of each.
std::vector<CoveredTexel> coverageOf(const SphericalPolygon& polygon, const ImageSize& size) {
  constexpr int kPoints = 4;
  const double centre = directionToUv(Mapping::LatLong, polygon.axis()).y * size.height;
  const double reach = polygon.capRadius() / kPiD * size.height + 1;
  const int top = std::max(0, int(std::floor(centre - reach)));
  const int bottom = std::min(size.height, int(std::ceil(centre + reach)));
  const Columns columns = columnsOf(polygon, size);
  std::vector<std::vector<CoveredTexel>> rows(size_t(std::max(0, bottom - top)));
  forRows(columns.end - columns.begin, bottom - top, kPoints * kPoints, [&](int row) {
    const int y = top + row;
    for (int column = columns.begin; column < columns.end; ++column) {
      const int x = (column + size.width) % size.width;
      int inside = 0;
      for (int i = 0; i < kPoints * kPoints; ++i) {
        const dvec2 uv((x + (i % kPoints + 0.5) / kPoints) / size.width,
                       (y + (i / kPoints + 0.5) / kPoints) / size.height);
        inside += polygon.contains(*uvToDirection(Mapping::LatLong, uv));
      }
      if (inside) rows[size_t(row)].push_back({{x, y}, float(inside) / (kPoints * kPoints)});
    }
  });
  std::vector<CoveredTexel> covered;
  for (const auto& row : rows) covered.insert(covered.end(), row.begin(), row.end());
  return covered;
}

// The mean radiance of the uncovered texels beside covered ones, by solid angle; 0 if there are
// none.
dvec3 meanOfRim(const Image& map, const std::vector<CoveredTexel>& coverage) {
  const auto indexOf = [&](int x, int y) {
    return size_t(y) * size_t(map.width) + size_t((x + map.width) % map.width);
  };
  std::vector<size_t> covered, beside, rim;
  for (const auto& [texel, part] : coverage) {
    covered.push_back(indexOf(texel.x, texel.y));
    for (int y = std::max(0, texel.y - 1); y <= std::min(map.height - 1, texel.y + 1); ++y)
      for (int x = texel.x - 1; x <= texel.x + 1; ++x) beside.push_back(indexOf(x, y));
  }
  std::ranges::sort(covered);
  std::ranges::sort(beside);
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  std::ranges::set_difference(beside, covered, std::back_inserter(rim));
  dvec3 sum(0);
  double weight = 0;
  for (const size_t i : rim) {
    const int x = int(i % size_t(map.width)), y = int(i / size_t(map.width));
    const double solidAngle = texelSolidAngle(y, map.width, map.height);
    sum += dvec3(map.rgb(x, y)) * solidAngle;
    weight += solidAngle;
  }
  return weight > 0 ? sum / weight : dvec3(0);
}

// The texel's radiance without the part that the polygon takes.
Rgb remaining(const Image& map, const CoveredTexel& covered, const dvec3& fill) {
  const dvec3 before(map.rgb(covered.texel.x, covered.texel.y));
  return Rgb(before - double(covered.part) * glm::max(before - fill, dvec3(0)));
}

PolygonSource sourceOf(const Image& map, const SphericalPolygon& polygon,
                       const std::vector<CoveredTexel>& coverage, const dvec3& fill) {
  PolygonSource source{polygon, dvec3(0)};
  dvec3 flux(0);  // radiance x solid angle
  for (const CoveredTexel& covered : coverage) {
    const auto [x, y] = covered.texel;
    const dvec3 own = (dvec3(map.rgb(x, y)) - dvec3(remaining(map, covered, fill))) *
                      texelSolidAngle(y, map.width, map.height);
    flux += own;
    source.coveredTexels += covered.part;
    const dvec3 direction = texelDirection({map.width, map.height}, x, y);
    for (int c = 0; c < 3; ++c) source.taken[size_t(c)] += own[c] * direction;
  }
  source.radiance = flux / polygon.solidAngle();
  return source;
}

dvec3 luminanceOf(const std::array<dvec3, 3>& channels) {
  return 0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2];
}

// Converts between positions in the file and in the map, for a map that was turned by 180 degrees
// on loading.
glm::dvec2 turned(const glm::dvec2& uv, const LoadedProbe& probe) {
  if (!probe.turned) return uv;
  return {uv.x < 0.5 ? uv.x + 0.5 : uv.x - 0.5, uv.y};
}

}  // namespace

dvec3 PolygonSource::direction() const {
  const dvec3 sum = luminanceOf(taken);
  return glm::length(sum) > 0 ? glm::normalize(sum) : glm::normalize(polygon.vectorIrradiance());
}

dvec3 PolygonSource::irradiance() const {
  return {glm::length(taken[0]), glm::length(taken[1]), glm::length(taken[2])};
}

double unevenness(std::span<const PolygonSource> sources) {
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    dvec3 change(0);
    double all = 0;
    for (const PolygonSource& source : sources) {
      const dvec3& taken = source.taken[size_t(c)];
      change += source.radiance[c] * source.polygon.vectorIrradiance() - taken;
      all += glm::length(taken);
    }
    if (all > 0) most = std::max(most, glm::length(change) / all);
  }
  return most;
}

PolygonSource sourceOf(const Image& map, const SphericalPolygon& polygon) {
  const std::vector<CoveredTexel> coverage = coverageOf(polygon, {map.width, map.height});
  return sourceOf(map, polygon, coverage, meanOfRim(map, coverage));
}

PolygonExtraction extractPolygons(const Image& latLong,
                                  const std::vector<SphericalPolygon>& polygons) {
  PolygonExtraction result;
  Image& rest = result.remainder =
      colorImage(latLong.width, latLong.height, [&](int x, int y) { return latLong.rgb(x, y); });
  for (const SphericalPolygon& polygon : polygons) {
    const std::vector<CoveredTexel> coverage = coverageOf(polygon, {rest.width, rest.height});
    const dvec3 fill = meanOfRim(rest, coverage);
    result.sources.push_back(sourceOf(rest, polygon, coverage, fill));
    for (const CoveredTexel& covered : coverage)
      rest.setRgb(covered.texel.x, covered.texel.y, remaining(rest, covered, fill));
  }
  return result;
}

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

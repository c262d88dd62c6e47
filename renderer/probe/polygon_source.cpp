// SPDX-License-Identifier: Apache-2.0
#include "probe/polygon_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>

#include "base/for_ranges.h"
#include "probe/bright_region.h"
#include "probe/mapping.h"
#include "probe/solid_angle.h"

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

// Those of a lat-long map that a cap may touch, in row y. At an elevation closer to a pole than the
// cap's rim, all; else the meridians that touch the cap, asin(sin(radius) / cos(elevation)) from
// its axis.
Columns columnsOf(const SphericalPolygon& polygon, const ImageSize& size) {
  const double radius = polygon.capRadius(),
               cosine = std::hypot(polygon.axis().x, polygon.axis().z);
  if (std::sin(radius) >= cosine) return {0, size.width};
  const double half = std::asin(std::sin(radius) / cosine) / (2 * kPiD) * size.width;
  const double centre = directionToUv(Mapping::LatLong, polygon.axis()).x * size.width;
  const Columns columns{int(std::floor(centre - half)) - 1, int(std::ceil(centre + half)) + 1};
  return columns.end - columns.begin < size.width ? columns : Columns{0, size.width};
}

// The texels of a lat-long map of which the polygon covers a part, from 4 x 4 points of each.
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

// The texel's radiance without what the polygon takes.
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

PolygonSource sourceOf(const Image& map, const SphericalPolygon& polygon) {
  const std::vector<CoveredTexel> coverage = coverageOf(polygon, {map.width, map.height});
  return sourceOf(map, polygon, coverage, meanOfRim(map, coverage));
}

dvec3 luminanceOf(const std::array<dvec3, 3>& channels) {
  return 0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2];
}

dvec3 centreOf(const Image& map, const std::vector<Texel>& region, double& flux) {
  dvec3 centre(0);
  flux = 0;
  for (const Texel t : region) {
    const double own = luminance(map.rgb(t.x, t.y)) * texelSolidAngle(t.y, map.width, map.height);
    centre += own * texelDirection({map.width, map.height}, t.x, t.y);
    flux += own;
  }
  return glm::normalize(centre);
}

// The convex hull of the texels' corners, of at most kMaxCorners; nullopt if the region is too
// wide.
std::optional<SphericalPolygon> hullOf(const Image& map, const std::vector<Texel>& region,
                                       const dvec3& centre) {
  constexpr double kLeastCosine = 0.5;  // of 60 degrees
  const dvec3 x = glm::normalize(
      glm::cross(std::fabs(centre.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), centre));
  const dvec3 y = glm::cross(centre, x);
  std::vector<dvec2> points;
  for (const Texel t : region)
    for (int corner = 0; corner < 4; ++corner) {
      const dvec2 uv(double(t.x + corner % 2) / map.width, double(t.y + corner / 2) / map.height);
      const dvec3 d = *uvToDirection(Mapping::LatLong, uv);
      const double cosine = glm::dot(d, centre);
      if (cosine < kLeastCosine) return {};
      points.push_back(dvec2(glm::dot(d, x), glm::dot(d, y)) / cosine);
    }
  std::vector<dvec2> hull = convexHull(std::move(points));
  while (hull.size() > SphericalPolygon::kMaxCorners) {  // cut off the smallest corner
    const size_t n = hull.size();
    size_t smallest = 0;
    double least = std::numeric_limits<double>::max();
    for (size_t i = 0; i < n; ++i) {
      const double area = std::fabs(
          signedArea(std::vector<dvec2>{hull[(i + n - 1) % n], hull[i], hull[(i + 1) % n]}));
      if (area < least) least = area, smallest = i;
    }
    hull.erase(hull.begin() + ptrdiff_t(smallest));
  }
  std::vector<dvec3> corners;
  for (const dvec2& p : hull) corners.push_back(glm::normalize(centre + p.x * x + p.y * y));
  return SphericalPolygon(corners, "region");
}

// A bright region and the polygon around it.
struct Candidate {
  std::vector<Texel> region;
  SphericalPolygon polygon;
  double flux;    // of luminance
  double uneven;  // unevenness()

  double unevenFlux() const {
    constexpr double kEven = 0.01;
    return uneven > kEven ? flux * uneven : 0;
  }
};

std::optional<Candidate> candidateOf(const Image& map, std::vector<Texel> region) {
  double flux;
  const dvec3 centre = centreOf(map, region, flux);
  auto polygon = hullOf(map, region, centre);
  if (!polygon) return {};
  const PolygonSource source = sourceOf(map, *polygon);
  return Candidate{std::move(region), *std::move(polygon), flux, unevenness({&source, 1})};
}

// By the plane through the centre of the flux, across the direction in which the flux is spread
// most. The hulls of the parts do not overlap.
std::array<std::vector<Texel>, 2> cut(const Image& map, const std::vector<Texel>& region) {
  double flux;
  const ImageSize size{map.width, map.height};
  const dvec3 centre = centreOf(map, region, flux);
  glm::dmat3 spread(0);
  for (const Texel t : region) {
    const dvec3 offset = texelDirection(size, t.x, t.y) - centre;
    const double weight =
        luminance(map.rgb(t.x, t.y)) * texelSolidAngle(t.y, map.width, map.height) / flux;
    spread += weight * glm::outerProduct(offset, offset);
  }
  constexpr int kIterations = 64;  // of the power method
  dvec3 axis(0.6, 0.5, 0.4);
  for (int i = 0; i < kIterations; ++i) {
    const dvec3 next = spread * (axis - glm::dot(axis, centre) * centre);
    if (!(glm::length(next) > 0)) break;
    axis = glm::normalize(next);
  }
  const dvec3 normal = axis - glm::dot(axis, centre) * centre;
  std::array<std::vector<Texel>, 2> parts;
  for (const Texel t : region)
    parts[glm::dot(texelDirection(size, t.x, t.y), normal) > 0].push_back(t);
  return parts;
}

// Where a cut of a candidate changes most light.
std::vector<Candidate>::iterator worstOf(std::vector<Candidate>& candidates) {
  return std::ranges::max_element(candidates, {}, &Candidate::unevenFlux);
}

// Replaces a candidate by its two parts, or notes that it has none.
void divide(const Image& map, std::vector<Candidate>& candidates,
            std::vector<Candidate>::iterator worst) {
  auto parts = cut(map, worst->region);
  if (parts[0].empty() || parts[1].empty()) {
    worst->uneven = 0;
    return;
  }
  candidates.erase(worst);
  for (std::vector<Texel>& part : parts)
    if (auto candidate = candidateOf(map, std::move(part)))
      candidates.push_back(*std::move(candidate));
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

PolygonExtraction extractPolygons(const Image& latLong,
                                  const std::vector<SphericalPolygon>& polygons) {
  PolygonExtraction result;
  Image& rest = result.remainder = Image(latLong.width, latLong.height, 3);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) rest.setRgb(x, y, latLong.rgb(x, y));
  for (const SphericalPolygon& polygon : polygons) {
    const std::vector<CoveredTexel> coverage = coverageOf(polygon, {rest.width, rest.height});
    const dvec3 fill = meanOfRim(rest, coverage);
    result.sources.push_back(sourceOf(rest, polygon, coverage, fill));
    for (const CoveredTexel& covered : coverage)
      rest.setRgb(covered.texel.x, covered.texel.y, remaining(rest, covered, fill));
  }
  return result;
}

std::vector<SphericalPolygon> suggestPolygons(const Image& latLong, int count) {
  constexpr double kContrast = 4;
  double mean = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      mean += luminance(latLong.rgb(x, y)) * texelSolidAngle(y, latLong.width, latLong.height) /
              (4 * kPiD);
  struct Region {
    std::vector<Texel> texels;
    double flux;
  };
  std::vector<Region> regions;
  std::vector<bool> visited(size_t(latLong.width) * size_t(latLong.height));
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) {
      Region region{gatherRegion(latLong, {x, y}, kContrast * mean, visited), 0};
      if (region.texels.empty()) continue;
      centreOf(latLong, region.texels, region.flux);
      regions.push_back(std::move(region));
    }
  std::ranges::stable_sort(regions, std::greater(), &Region::flux);
  std::vector<Candidate> candidates;
  auto region = regions.begin();
  while (candidates.size() < size_t(count)) {
    const auto worst = worstOf(candidates);
    const double uneven = worst == candidates.end() ? 0 : worst->unevenFlux();
    if (region != regions.end() && region->flux > uneven) {
      if (auto candidate = candidateOf(latLong, std::move((region++)->texels)))
        candidates.push_back(*std::move(candidate));
    } else if (uneven > 0) {
      divide(latLong, candidates, worst);
    } else {
      break;
    }
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::flux);
  std::vector<SphericalPolygon> best;
  for (Candidate& candidate : candidates) best.push_back(std::move(candidate.polygon));
  return best;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/polygon_source.h"

#include <functional>
#include <limits>
#include <optional>

#include "probe/mapping.h"
#include "probe/sun_extraction.h"

namespace chromeball {
namespace {

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
struct PolygonCandidate {
  std::vector<Texel> region;
  SphericalPolygon polygon;
  double flux;    // of luminance
  double uneven;  // unevenness()

  double unevenFlux() const {
    constexpr double kEven = 0.01;
    return uneven > kEven ? flux * uneven : 0;
  }
};

std::optional<PolygonCandidate> candidateOf(const Image& map, std::vector<Texel> region) {
  double flux;
  const dvec3 centre = centreOf(map, region, flux);
  auto polygon = hullOf(map, region, centre);
  if (!polygon) return {};
  const PolygonSource source = sourceOf(map, *polygon);
  return PolygonCandidate{std::move(region), *std::move(polygon), flux, unevenness({&source, 1})};
}

// Cuts a region by the plane through the centre of the flux, across the direction in which the flux
// is spread most. The hulls of the parts do not overlap.
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

// The candidate whose cut changes most light.
std::vector<PolygonCandidate>::iterator worstOf(std::vector<PolygonCandidate>& candidates) {
  return std::ranges::max_element(candidates, {}, &PolygonCandidate::unevenFlux);
}

// Replaces a candidate by its two parts, or notes that it has none.
void divide(const Image& map, std::vector<PolygonCandidate>& candidates,
            std::vector<PolygonCandidate>::iterator worst) {
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

std::vector<SphericalPolygon> suggestPolygons(const Image& latLong, int count) {
  constexpr double kContrast = 4;
  double mean = 0;
  forTexels(latLong, [&](int, int, const Rgb& c, double solidAngle) {
    mean += luminance(c) * solidAngle / (4 * kPiD);
  });
  struct Region {
    std::vector<Texel> texels;
    double flux;
  };
  std::vector<Region> regions;
  for (std::vector<Texel>& texels : brightRegions(latLong, kContrast * mean)) {
    Region& region = regions.emplace_back(Region{std::move(texels), 0});
    centreOf(latLong, region.texels, region.flux);
  }
  std::ranges::stable_sort(regions, std::greater(), &Region::flux);
  std::vector<PolygonCandidate> candidates;
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
  std::ranges::stable_sort(candidates, std::greater(), &PolygonCandidate::flux);
  std::vector<SphericalPolygon> best;
  for (PolygonCandidate& candidate : candidates) best.push_back(std::move(candidate.polygon));
  return best;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/polygon_source.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/for_ranges.h"
#include "probe/bright_region.h"
#include "probe/mapping.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// The fraction of each texel that the polygon covers, from 4 x 4 points.
std::vector<float> coverageOf(const SphericalPolygon& polygon, const ImageSize& size) {
  constexpr int kPoints = 4;
  std::vector<float> coverage(size_t(size.width) * size_t(size.height));
  forRows(size.width, size.height, kPoints * kPoints, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      int inside = 0;
      for (int i = 0; i < kPoints * kPoints; ++i) {
        const dvec2 uv((x + (i % kPoints + 0.5) / kPoints) / size.width,
                       (y + (i / kPoints + 0.5) / kPoints) / size.height);
        inside += polygon.contains(*uvToDirection(Mapping::LatLong, uv));
      }
      coverage[size_t(y) * size_t(size.width) + size_t(x)] = float(inside) / (kPoints * kPoints);
    }
  });
  return coverage;
}

// The mean radiance of the uncovered texels beside covered ones, by solid angle; 0 if there are
// none.
dvec3 meanOfRim(const Image& map, const std::vector<float>& coverage) {
  const auto covered = [&](int x, int y) {
    return y >= 0 && y < map.height &&
           coverage[size_t(y) * size_t(map.width) + size_t((x + map.width) % map.width)] > 0;
  };
  dvec3 sum(0);
  double weight = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      if (covered(x, y)) continue;
      bool isRim = false;
      for (int i = 0; i < 9 && !isRim; ++i) isRim = covered(x + i % 3 - 1, y + i / 3 - 1);
      if (!isRim) continue;
      const double solidAngle = texelSolidAngle(y, map.width, map.height);
      sum += dvec3(map.rgb(x, y)) * solidAngle;
      weight += solidAngle;
    }
  return weight > 0 ? sum / weight : dvec3(0);
}

dvec3 removeCovered(Image& map, const std::vector<float>& coverage, const dvec3& fill) {
  dvec3 taken(0);  // radiance x solid angle
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double part = coverage[size_t(y) * size_t(map.width) + size_t(x)];
      if (part == 0) continue;
      const dvec3 before(map.rgb(x, y));
      const Rgb after(before - part * glm::max(before - fill, dvec3(0)));
      taken += (before - dvec3(after)) * texelSolidAngle(y, map.width, map.height);
      map.setRgb(x, y, after);
    }
  return taken;
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

}  // namespace

dvec3 PolygonSource::irradiance() const {
  return radiance * glm::length(polygon.vectorIrradiance());
}

PolygonExtraction extractPolygons(const Image& latLong,
                                  const std::vector<SphericalPolygon>& polygons) {
  PolygonExtraction result;
  result.remainder = Image(latLong.width, latLong.height, 3);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) result.remainder.setRgb(x, y, latLong.rgb(x, y));
  for (const SphericalPolygon& polygon : polygons) {
    const std::vector<float> coverage = coverageOf(polygon, {latLong.width, latLong.height});
    const dvec3 fill = meanOfRim(result.remainder, coverage);
    const dvec3 taken = removeCovered(result.remainder, coverage, fill);
    result.sources.push_back({polygon, taken / polygon.solidAngle(),
                              std::accumulate(coverage.begin(), coverage.end(), 0.0)});
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
  struct Candidate {
    SphericalPolygon polygon;
    double flux;
  };
  std::vector<Candidate> candidates;
  std::vector<bool> visited(size_t(latLong.width) * size_t(latLong.height));
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) {
      const std::vector<Texel> region = gatherRegion(latLong, {x, y}, kContrast * mean, visited);
      if (region.empty()) continue;
      double flux;
      const dvec3 centre = centreOf(latLong, region, flux);
      if (auto polygon = hullOf(latLong, region, centre))
        candidates.push_back({*std::move(polygon), flux});
    }
  std::ranges::sort(candidates,
                    [](const Candidate& a, const Candidate& b) { return a.flux > b.flux; });
  std::vector<SphericalPolygon> best;
  for (size_t i = 0; i < std::min(candidates.size(), size_t(count)); ++i)
    best.push_back(candidates[i].polygon);
  return best;
}

}  // namespace chromeball

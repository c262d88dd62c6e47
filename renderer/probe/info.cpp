#include "probe/info.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "probe/solid_angle.h"

namespace chromeball {
namespace {

dvec3 centreDirection(const Image& image, int x, int y) {
  return *uvToDirection(Mapping::LatLong, {(x + 0.5) / image.width, (y + 0.5) / image.height});
}

double fluxOf(const Image& image, int x, int y) {
  return luminance(image.rgb(x, y)) * texelSolidAngle(y, image.width, image.height);
}

struct Texel {
  int x, y;
};

// All texels connected to `start`, over eight neighbours and the seam, that are brighter than
// `threshold` and not yet `visited`.
std::vector<Texel> gatherRegion(const Image& image, Texel start, float threshold,
                                std::vector<bool>& visited) {
  std::vector<Texel> region;
  const auto visit = [&](int x, int y) {
    x = (x + image.width) % image.width;
    if (y < 0 || y >= image.height) return;
    const size_t index = size_t(y) * image.width + x;
    if (visited[index] || luminance(image.rgb(x, y)) <= threshold) return;
    visited[index] = true;
    region.push_back({x, y});
  };
  visit(start.x, start.y);
  for (size_t i = 0; i < region.size(); ++i) {
    const Texel t = region[i];
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) visit(t.x + dx, t.y + dy);
  }
  return region;
}

std::vector<BrightestShare> brightestShares(const Image& image) {
  const size_t count = size_t(image.width) * image.height;
  std::vector<double> flux(count);
  std::vector<float> brightness(count);
  for (size_t i = 0; i < count; ++i) {
    const int x = int(i % image.width), y = int(i / image.width);
    flux[i] = fluxOf(image, x, y);
    brightness[i] = luminance(image.rgb(x, y));
  }
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t(0));
  const double total = std::accumulate(flux.begin(), flux.end(), 0.0);

  const size_t percent = std::max<size_t>(1, count / 100);
  std::vector<BrightestShare> shares;
  std::vector<size_t> counts{1, 10, 100, percent};
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const size_t brightest : counts) {
    if (brightest > count) continue;
    std::nth_element(order.begin(), order.begin() + (brightest - 1), order.end(),
                     [&](size_t a, size_t b) { return brightness[a] > brightness[b]; });
    double sum = 0;
    for (size_t i = 0; i < brightest; ++i) sum += flux[order[i]];
    shares.push_back({brightest, total > 0 ? sum / total : 0});
  }
  return shares;
}

}  // namespace

std::vector<FoundSun> findSuns(const Image& image) {
  constexpr double kFarBrighter = 100, kLeastShare = 0.01, kWidest = 6;
  const double meanLuminance = luminance(Rgb(meanRadiance(image)));
  const float threshold = float(kFarBrighter * meanLuminance);
  std::vector<bool> visited(size_t(image.width) * image.height);
  std::vector<FoundSun> suns;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::vector<Texel> region = gatherRegion(image, {x, y}, threshold, visited);
      if (region.empty()) continue;
      double flux = 0, solidAngle = 0;
      dvec3 centroid(0);
      for (const Texel& t : region) {
        flux += fluxOf(image, t.x, t.y);
        centroid += centreDirection(image, t.x, t.y) * fluxOf(image, t.x, t.y);
        solidAngle += texelSolidAngle(t.y, image.width, image.height);
      }
      FoundSun sun{};
      sun.direction = glm::normalize(centroid);
      sun.angularDiameter = 2 * std::acos(std::max(-1.0, 1 - solidAngle / (2 * kPiD))) * 180 / kPiD;
      const bool small = sun.angularDiameter <= kWidest || region.size() == 1;
      if (!small || flux < kLeastShare * 4 * kPiD * meanLuminance) continue;
      for (const Texel& t : region)
        sun.irradiance += dvec3(image.rgb(t.x, t.y)) *
                          texelSolidAngle(t.y, image.width, image.height) *
                          std::max(0.0, glm::dot(sun.direction, centreDirection(image, t.x, t.y)));
      suns.push_back(sun);
    }
  std::sort(suns.begin(), suns.end(), [](const FoundSun& a, const FoundSun& b) {
    return luminance(Rgb(a.irradiance)) > luminance(Rgb(b.irradiance));
  });
  return suns;
}

ProbeInfo probeInfo(const Image& image) {
  ProbeInfo info;
  info.min = Rgb(std::numeric_limits<float>::max());
  float darkest = std::numeric_limits<float>::max(), brightest = -1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.rgb(x, y);
      const float l = luminance(c);
      info.min = glm::min(info.min, c);
      info.max = glm::max(info.max, c);
      info.mean += dvec3(c);
      if (l > 0) darkest = std::min(darkest, l);
      if (l > brightest) {
        brightest = l;
        info.brightest = c;
        info.brightestDirection = centreDirection(image, x, y);
      }
    }
  info.mean /= double(image.width) * image.height;
  info.meanRadiance = meanRadiance(image);
  info.dynamicRange = brightest > 0 ? double(brightest) / darkest : 0;
  info.suns = findSuns(image);
  info.brightestShares = brightestShares(image);
  return info;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/sun_extraction.h"

#include <utility>

#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball {
namespace {

double sinOfRadius(const Sun& sun) { return std::sin(sun.angle * (kPiD / 360)); }

constexpr double kContrast = 2000, kMinContrast = 10;  // times the mean luminance
constexpr double kMinFraction = 0.01;                  // of the flux
constexpr double kWidest = 90;                         // of a sun's diameter, degrees
constexpr double kGlowContrast = 20;
constexpr double kDegree = kPiD / 180;
constexpr double kMaxCore = 3 * kDegree, kMaxGlow = 6 * kDegree;  // radii

dvec3 centreDirection(const Image& image, Texel t) {
  return texelDirection({image.width, image.height}, t.x, t.y);
}

// The angle between unit vectors; accurate for small angles.
double angleBetweenUnit(const dvec3& a, const dvec3& b) {
  return 2 * std::asin(std::min(1.0, 0.5 * glm::distance(a, b)));
}

double largestTexelSide(const Image& image) {
  return std::max(2 * kPiD / image.width, kPiD / image.height);
}

// A candidate sun.
struct Core {
  dvec3 centre;
  double radius;  // radians, to the centre of its furthest texel
  double flux;
  Texel brightest;
};

Core coreOf(const Image& image, const std::vector<Texel>& region) {
  Core core{dvec3(0), 0, 0, region.front()};
  const auto brightness = [&](Texel t) { return luminance(image.rgb(t.x, t.y)); };
  for (const Texel t : region) {
    const double flux = brightness(t) * texelSolidAngle(t.y, image.width, image.height);
    core.flux += flux;
    core.centre += centreDirection(image, t) * flux;
    if (brightness(t) > brightness(core.brightest)) core.brightest = t;
  }
  core.centre = glm::normalize(core.centre);
  for (const Texel t : region)
    core.radius = std::max(core.radius, angleBetweenUnit(core.centre, centreDirection(image, t)));
  return core;
}

// The cores in order of decreasing flux, without regions too wide for a sun.
std::vector<Core> findCores(const Image& image, double threshold) {
  const double maxRadius = std::max(kMaxCore, largestTexelSide(image));
  std::vector<Core> cores;
  for (const std::vector<Texel>& region : brightRegions(image, threshold))
    if (const Core core = coreOf(image, region); core.radius <= maxRadius) cores.push_back(core);
  std::sort(cores.begin(), cores.end(),
            [](const Core& a, const Core& b) { return a.flux > b.flux; });
  return cores;
}

// The texels whose centres are more than `inner` and at most `outer` radians from `centre`.
std::vector<Texel> texelsAround(const Image& image, const dvec3& centre, double inner,
                                double outer) {
  const int w = image.width, h = image.height;
  const double theta = std::acos(std::clamp(centre.y, -1.0, 1.0));
  const int top = std::max(0, int((theta - outer) / kPiD * h));
  const int bottom = std::min(h - 1, int((theta + outer) / kPiD * h));
  const bool containsPole = theta <= outer || theta + outer >= kPiD;
  const double reach =
      containsPole ? 0.5 : std::asin(std::min(1.0, std::sin(outer) / std::sin(theta))) / (2 * kPiD);
  const int first = int(std::floor((directionToUv(Mapping::LatLong, centre).x - reach) * w));
  const int count = std::min(w, int(std::ceil(2 * reach * w)) + 1);
  std::vector<Texel> texels;
  for (int y = top; y <= bottom; ++y)
    for (int i = 0; i < count; ++i) {
      const Texel t{((first + i) % w + w) % w, y};
      const double angle = angleBetweenUnit(centre, centreDirection(image, t));
      if (angle > inner && angle <= outer) texels.push_back(t);
    }
  return texels;
}

double medianLuminance(const Image& image, const std::vector<Texel>& texels) {
  std::vector<float> values;
  for (const Texel t : texels) values.push_back(luminance(image.rgb(t.x, t.y)));
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct Glow {
  std::vector<Texel> inside, ring;
};

Glow glowAround(const Image& image, const Core& core, double meanLuminance) {
  const double texel = largestTexelSide(image);
  for (double radius = core.radius + 2 * texel;; radius *= 1.2) {
    std::vector<Texel> ring = texelsAround(image, core.centre, radius, radius + 1.5 * texel);
    const double median = medianLuminance(image, ring);
    if (radius * 1.2 <= kMaxGlow && median > kGlowContrast * meanLuminance) continue;
    // Other sources on the ring, such as another sun, must not raise the interpolated radiance.
    std::erase_if(ring, [&](Texel t) { return luminance(image.rgb(t.x, t.y)) > 4 * median; });
    return {texelsAround(image, core.centre, -1, radius), std::move(ring)};
  }
}

// Radiance inside a ring, interpolated from it by inverse squared distance (Shepard 1968).
struct RingTexel {
  dvec3 direction, radiance;
};
dvec3 interpolate(const std::vector<RingTexel>& ring, const dvec3& direction) {
  dvec3 sum(0);
  double weights = 0;
  for (const RingTexel& t : ring) {
    const dvec3 to = t.direction - direction;
    const double weight = 1 / glm::dot(to, to);
    sum += t.radiance * weight;
    weights += weight;
  }
  return weights > 0 ? sum / weights : sum;
}

// The radiance that a texel loses to a sun, constant over the texel, and the radiance it keeps.
struct Removed {
  Texel texel;
  dvec3 radiance;
  Rgb kept;
};

std::vector<Removed> lightInside(const Glow& glow, const Image& image) {
  std::vector<RingTexel> ring;
  for (const Texel t : glow.ring)
    ring.push_back({centreDirection(image, t), dvec3(image.rgb(t.x, t.y))});
  std::vector<Removed> removed;
  for (const Texel t : glow.inside) {
    const Rgb radiance = image.rgb(t.x, t.y);
    const Rgb kept = glm::min(radiance, Rgb(interpolate(ring, centreDirection(image, t))));
    removed.push_back({t, dvec3(radiance) - dvec3(kept), kept});
  }
  return removed;
}

// Calls f(direction, radiance, solid angle) for 4 x 4 parts of each texel of a w x h map, small
// enough to use the direction at their centres.
template <class F>
void forEachPart(const std::vector<Removed>& removed, int w, int h, F f) {
  constexpr int kParts = 4;
  for (const Removed& r : removed)
    for (int j = 0; j < kParts; ++j)
      for (int i = 0; i < kParts; ++i) {
        const int x = r.texel.x * kParts + i, y = r.texel.y * kParts + j;
        f(texelDirection({w * kParts, h * kParts}, x, y), r.radiance,
          texelSolidAngle(y, w * kParts, h * kParts));
      }
}

Sun discOf(const std::vector<Removed>& removed, int w, int h) {
  dvec3 moment[3] = {dvec3(0), dvec3(0), dvec3(0)};
  forEachPart(removed, w, h, [&](const dvec3& d, const dvec3& radiance, double solidAngle) {
    for (int c = 0; c < 3; ++c) moment[c] += d * (radiance[c] * solidAngle);
  });
  Sun sun{};
  sun.direction = glm::normalize(0.2126 * moment[0] + 0.7152 * moment[1] + 0.0722 * moment[2]);
  for (int c = 0; c < 3; ++c) sun.irradiance[c] = std::max(0.0, glm::dot(moment[c], sun.direction));

  double flux = 0, distance = 0;
  forEachPart(removed, w, h, [&](const dvec3& d, const dvec3& radiance, double solidAngle) {
    const double part = luminance(Rgb(radiance)) * solidAngle;
    flux += part;
    distance += part * angleBetweenUnit(sun.direction, d);
  });
  sun.angle = 2 * 1.5 * distance / flux / kDegree;  // the mean over a disc is 2/3 of its radius
  return sun;
}

}  // namespace

glm::dvec3 Sun::radiance() const {
  const double sine = sinOfRadius(*this);
  return irradiance / (kPiD * sine * sine);
}

// Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering" (2014), the function
// illuminanceSphereOrDisk.
glm::dvec3 Sun::irradianceOn(const glm::dvec3& normal) const {
  const double cosine = glm::dot(normal, direction), sinRadius = sinOfRadius(*this);
  if (cosine >= sinRadius) return irradiance * cosine;
  if (cosine <= -sinRadius) return glm::dvec3(0);
  const double square = sinRadius * sinRadius, x = std::sqrt(1 / square - 1);
  const double sine = std::sqrt(1 - cosine * cosine);
  const double y = std::clamp(-x * cosine / sine, -1.0, 1.0);
  const double chord = sine * std::sqrt(1 - y * y);
  const double seen = (cosine * std::acos(y) - x * chord) * square + std::atan(chord / x);
  return irradiance * (seen / (kPiD * square));
}

SunExtraction extractSuns(const Image& latLong) {
  const int w = latLong.width, h = latLong.height;
  SunExtraction result;
  Image& remainder = result.remainder =
      colorImage(w, h, [&](int x, int y) { return latLong.rgb(x, y); });

  const double mean = luminance(Rgb(meanRadiance(latLong)));
  const double sunRadius = 0.5 * kSunDiameter * kDegree;
  const double diluted = kPiD * sunRadius * sunRadius / (2 * kPiD / w * kPiD / h);
  const double threshold = mean * std::clamp(kContrast * diluted, kMinContrast, kContrast);
  for (const Core& core : findCores(remainder, threshold)) {
    // This core may already have been removed as part of another sun's glow.
    if (luminance(remainder.rgb(core.brightest.x, core.brightest.y)) <= threshold) continue;
    const std::vector<Removed> removed = lightInside(glowAround(remainder, core, mean), remainder);
    double flux = 0;
    for (const Removed& r : removed)
      flux += luminance(Rgb(r.radiance)) * texelSolidAngle(r.texel.y, w, h);
    if (flux < kMinFraction * 4 * kPiD * mean) continue;
    const Sun sun = discOf(removed, w, h);
    if (!(sun.angle <= kWidest)) continue;  // of texels that are too coarse for any disc
    result.suns.push_back(sun);
    for (const Removed& r : removed) remainder.setRgb(r.texel.x, r.texel.y, r.kept);
  }
  std::sort(result.suns.begin(), result.suns.end(), [](const Sun& a, const Sun& b) {
    return luminance(Rgb(a.irradiance)) > luminance(Rgb(b.irradiance));
  });
  return result;
}

std::vector<std::vector<Texel>> brightRegions(const Image& latLong, double threshold) {
  std::vector<std::vector<Texel>> regions;
  std::vector<bool> visited(size_t(latLong.width) * latLong.height);
  std::vector<Texel> region;
  const auto visit = [&](int x, int y) {
    x = (x + latLong.width) % latLong.width;
    const size_t index = size_t(y) * latLong.width + x;
    if (visited[index] || luminance(latLong.rgb(x, y)) <= threshold) return;
    visited[index] = true;
    region.push_back({x, y});
  };
  for (int startY = 0; startY < latLong.height; ++startY)
    for (int startX = 0; startX < latLong.width; ++startX) {
      visit(startX, startY);
      for (size_t i = 0; i < region.size(); ++i) {
        const Texel t = region[i];
        for (int y = std::max(t.y - 1, 0); y <= std::min(t.y + 1, latLong.height - 1); ++y)
          for (int dx = -1; dx <= 1; ++dx) visit(t.x + dx, y);
      }
      if (!region.empty()) regions.push_back(std::exchange(region, {}));
    }
  return regions;
}

}  // namespace chromeball

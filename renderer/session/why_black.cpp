// SPDX-License-Identifier: Apache-2.0
// Explains why a rendered image shows nothing.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "math/icosphere.h"
#include "scene/surface.h"
#include "session/render_messages.h"
#include "trace/accel.h"

namespace chromeball {
namespace {

constexpr int kMaxSurfaces = 64;  // that one ray passes

// The first surface along the ray that `stops`, passing the surfaces before it.
template <class Stops>
std::optional<Surface> firstSurface(const Accel& accel, Ray ray, const Stops& stops) {
  const Scene& scene = accel.scene();
  Hit hit;
  for (int i = 0; i < kMaxSurfaces && accel.intersect(ray, 0, hit); ++i) {
    const Surface surface = surfaceAt(scene, scene.instances[hit.instance], hit.triangle,
                                      hit.barycentric, -ray.direction, 0, ray.time);
    if (stops(surface)) return surface;
    const float left = ray.tMax - hit.distance;
    ray = rayFrom(surface, ray.direction, left);
  }
  return std::nullopt;
}

// Over the sphere, in W/(m^2 sr).
float meanLuminance(const Probe& probe) {
  std::vector<double> rows(size_t(probe.height()));
  parallelFor(0, probe.height(), [&](int y) {
    double& sum = rows[size_t(y)];
    for (int x = 0; x < probe.width(); ++x) sum += luminance(probe.corners(x, y + 1).c00);
    const double top = kPiD * y / probe.height(), bottom = kPiD * (y + 1) / probe.height();
    sum *= std::cos(top) - std::cos(bottom);
  });
  return float(std::reduce(rows.begin(), rows.end()) / (2 * probe.width()));
}

// The surfaces that the camera sees through the pixels of a grid.
struct Seen {
  std::vector<Surface> black;  // visible surfaces in pixels that are black
  int surfaces = 0;            // pixels with a visible surface
  int hidden = 0;              // with none, but the hidden back of one
};

Seen lookThrough(const LoadedScene& loaded, const Accel& accel, const Image& mean, float dark,
                 int grid) {
  const CameraRays camera(loaded.camera, float(mean.width) / float(mean.height));
  const int columns = std::min(grid, mean.width), rows = std::min(grid, mean.height);
  Seen seen;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int x = int(int64_t(i) * mean.width / columns);
      const int y = int(int64_t(j) * mean.height / rows);
      Ray ray;
      camera.ray((float(x) + 0.5f) / float(mean.width), (float(y) + 0.5f) / float(mean.height),
                 ray.origin, ray.direction);
      bool passesBack = false;
      const std::optional<Surface> surface = firstSurface(accel, ray, [&](const Surface& s) {
        const bool isHidden = !s.frontFace && s.material->hidesBack();
        passesBack |= isHidden;
        return !isHidden;
      });
      seen.surfaces += surface.has_value();
      seen.hidden += !surface && passesBack;
      if (surface && luminance(mean.rgb(x, y)) <= dark) seen.black.push_back(*surface);
    }
  return seen;
}

struct Target {
  vec3 direction;                     // unit, or
  std::optional<vec3> position = {};  // a lamp's
};

// Directions in proportion to the probe's light.
void addProbe(const Probe& probe, std::vector<Target>& targets) {
  constexpr int kCount = 64;
  std::vector<vec3> directions;
  std::vector<double> sums;
  double sum = 0;
  for (int row = 0; row < probe.cellRows(); ++row)
    for (int column = 0; column < probe.width(); ++column) {
      Probe::Position middle{column, row, 0.5f, 0.5f, 0};
      directions.push_back(probe.direction(middle));
      sums.push_back(sum += double(luminance(probe.radiance(middle))) * double(middle.sinTheta));
    }
  for (int k = 0; k < kCount && sum > 0; ++k) {
    const auto at = std::ranges::lower_bound(sums, (k + 0.5) / kCount * sum);
    targets.push_back({directions[size_t(at - sums.begin())]});
  }
}

std::vector<Target> lightsOf(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  std::vector<Target> targets;
  addProbe(loaded.probe, targets);
  for (const SunLamp& lamp : scene.suns) targets.push_back({vec3(lamp.sun.direction)});
  for (const PunctualLight& light : scene.lights)
    light.kind == PunctualLight::Kind::Directional
        ? targets.push_back({-light.direction})
        : targets.push_back({.direction = {}, .position = light.position});
  if (!scene.ambient.empty())
    for (const vec3& direction : icosphereNormals(0)) targets.push_back({direction});
  return targets;
}

// Whether single-sided walls alone hide the light from the surface: a ray to it passes the fronts
// of some, which it would if sides counted for light, and meets nothing else.
bool isBehindWalls(const Accel& accel, const Surface& surface, const std::vector<Target>& lights) {
  return std::ranges::any_of(lights, [&](const Target& light) {
    const vec3 way = light.position ? *light.position - surface.position : light.direction;
    if (!(glm::dot(way, surface.geometricNormal) > 0)) return false;
    const vec3 direction = glm::normalize(way);
    const float length = light.position ? glm::length(way) : INFINITY;
    bool passesWall = false;
    const auto blocks = [&](const Surface& s) {
      const bool isWall = s.frontFace && s.material->hidesBack();
      passesWall |= isWall;
      return !isWall;
    };
    return !firstSurface(accel, rayFrom(surface, direction, length), blocks) && passesWall;
  });
}

// Whether the surface reflects nothing, whatever light reaches it.
bool absorbsAll(const Scene& scene, const Surface& surface) {
  const MaterialPoint m = materialAt(scene, surface);
  if (!isBlack(m.baseColor)) return false;
  return surface.material->unlit ||
         (m.metallic == 0 && m.dielectricF90 == 0 && !surface.material->extended);
}

// The reason why the camera sees no surface; empty if it may see one. The search ends at the first
// visible surface.
std::string whyNoneShows(const Scene& scene) {
  constexpr std::array<vec2, 7> kPoints = {vec2(1.f / 3),     vec2(0.05f, 0.05f), vec2(0.9f, 0.05f),
                                           vec2(0.05f, 0.9f), vec2(0.45f, 0.45f), vec2(0.1f, 0.45f),
                                           vec2(0.45f, 0.1f)};
  bool anyArea = false;
  for (const Instance& instance : scene.instances) {
    const std::vector<Triangle>& triangles = scene.meshes[size_t(instance.mesh)].triangles;
    for (uint32_t i = 0; i < triangles.size(); ++i) {
      const auto [a, b, c] = cornersAt(scene, instance, triangles[i], 0);
      if (!(glm::length(glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a))) > 0)) continue;
      anyArea = true;
      if (std::ranges::any_of(kPoints, [&](const vec2& barycentric) {
            return surfaceAlpha(scene, instance, i, barycentric) > 0;
          }))
        return "";
    }
  }
  return anyArea ? "no surface is visible: all have an alpha of 0, or one below their alphaCutoff"
                 : "no surface is visible: all triangles have no area";
}

std::string noneInView(const Scene& scene, const Seen& seen, const SettingWords& words) {
  if (const std::string cause = whyNoneShows(scene); !cause.empty()) return cause;
  if (seen.hidden > 0)
    return "no surface is in view: the camera is behind single-sided ones, whose backs it does not "
           "see; try " +
           words("render.single_sided", "off") + ", or another camera";
  return "no surface is in view; try another camera";
}

// The limits that took light which the paths would have found; nearly all, by the clamp. Much of
// the light may be that of the background.
std::vector<std::string> limitsOf(const RenderSettings& settings, const RenderResult& result,
                                  const SettingWords& words) {
  constexpr double kLeast = 1e-3, kNearlyAll = 0.95;
  std::vector<std::string> limits;
  for (size_t i = 0; i < DepthCut::kLimits; ++i) {
    const DepthLimit limit = DepthLimit(i);
    // Of few samples, the estimate may have none.
    const bool isZero = limit == DepthLimit::Diffuse && settings.maxDiffuseDepth == 0;
    if (isZero || result.depthCut.fraction(limit) > kLeast)
      limits.push_back(limitInWords(limit, settings, words));
  }
  if (result.clamped.fractionRemoved() > kNearlyAll)
    limits.push_back(words("clamp", fmt::format("{:g}", *settings.clamp)));
  return limits;
}

// The settings that left light out before anything was rendered.
std::vector<std::string> removedLight(const LoadedScene& loaded, const SettingWords& words) {
  const LightingDescription& lighting = loaded.description.lighting;
  std::vector<std::string> removed;
  if (lighting.from == LightFrom::Suns) removed.push_back(words("lighting.from", "suns"));
  if (lighting.from == LightFrom::Rest) removed.push_back(words("lighting.from", "rest"));
  if (lighting.lamps == 0 && loaded.hasModelLights)
    removed.push_back(words("lighting.lights", "off"));
  return removed;
}

std::string noLightWith(const std::vector<std::string>& settings) {
  return fmt::format("no light reaches them with {}; leave {} out", fmt::join(settings, " and "),
                     settings.size() == 1 ? "it" : "them");
}

}  // namespace

std::optional<std::string> whyBlack(const LoadedScene& loaded, const Accel& accel,
                                    const RenderResult& result, const SettingWords& words) {
  const RenderDescription& description = loaded.description;
  const Image mean = result.film.mean();
  constexpr float kDark = 1e-4f;  // of the probe's mean, or of 1: lamps, or a part of the probe,
                                  // may light a picture well under a probe that is far brighter
  constexpr double kMax = 0.8, kNearlyAll = 0.95;
  constexpr int kGrid = 48, kFine = 1024;
  const float probeMean = meanLuminance(loaded.probe);
  const Seen seen = lookThrough(loaded, accel, mean, kDark * std::min(probeMean, 1.0f), kGrid);
  if (seen.surfaces == 0) {
    const Seen finer = lookThrough(loaded, accel, mean, 0, kFine);
    return finer.surfaces == 0 ? std::optional(noneInView(loaded.scene, finer, words))
                               : std::nullopt;
  }
  const double black = double(seen.black.size()) / seen.surfaces;
  if (description.settings.maxDepth == 0 || black < kMax)
    return std::nullopt;  // at 0, only emitters shine
  const std::string what = fmt::format("{:.0f}% of the visible surfaces are black: ", 100 * black);
  if (description.probe.scale == glm::dvec3(0))
    return what + words("probe.scale", "0") + " turns the probe off";
  if (const auto limits = limitsOf(description.settings, result, words); !limits.empty())
    return what + noLightWith(limits);
  const auto absorbing = std::ranges::count_if(
      seen.black, [&](const Surface& surface) { return absorbsAll(loaded.scene, surface); });
  if (2 * size_t(absorbing) > seen.black.size()) return what + "their materials reflect nothing";
  const std::vector<Target> lights = lightsOf(loaded);
  const auto behindWalls = std::ranges::count_if(
      seen.black, [&](const Surface& surface) { return isBehindWalls(accel, surface, lights); });
  const bool lets = std::ranges::any_of(loaded.scene.materials,
                                        [](const Material& m) { return m.backLetsLightThrough(); });
  if (!lets && 2 * size_t(behindWalls) > seen.black.size())
    return what + "single-sided walls, which the camera sees through, block the light; try " +
           words("render.single_sided", "light") + ", or add lamps with [[light]] in a scene file";
  if (black < kNearlyAll) return std::nullopt;
  if (const auto removed = removedLight(loaded, words); !removed.empty())
    return what + noLightWith(removed);
  if (lights.empty() && (description.probe.file || description.probe.map))
    return what + "the probe is black; take another, or add lamps with [[light]] in a scene file";
  return what + "no light reaches them; add lamps with [[light]] in a scene file";
}

}  // namespace chromeball

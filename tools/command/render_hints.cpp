// SPDX-License-Identifier: Apache-2.0
#include "render_hints.h"

#include <fmt/format.h>

#include <algorithm>

#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// Of a coarse grid of pixels, those whose rays meet a surface first, or its back; those of them
// that are black, and whose surface is single-sided.
struct Seen {
  int surfaces = 0, black = 0, blackSingleSided = 0;
};

bool isSingleSided(const Scene& scene, const Hit& hit) {
  return scene.materials[size_t(scene.instances[hit.instance].material)].hidesBack();
}

Seen lookAround(const LoadedScene& loaded, const Accel& accel, const Image& mean, float dark) {
  constexpr int kGrid = 48;
  const CameraRays camera(loaded.camera, float(mean.width) / float(mean.height));
  Seen seen;
  for (int j = 0; j < kGrid; ++j)
    for (int i = 0; i < kGrid; ++i) {
      const int x = i * mean.width / kGrid, y = j * mean.height / kGrid;
      Ray ray;
      camera.ray((float(x) + 0.5f) / float(mean.width), (float(y) + 0.5f) / float(mean.height),
                 ray.origin, ray.direction);
      Hit hit;
      if (!accel.intersect(ray, 0, hit)) continue;
      ++seen.surfaces;
      if (luminance(mean.rgb(x, y)) > dark) continue;
      ++seen.black;
      seen.blackSingleSided += isSingleSided(loaded.scene, hit);
    }
  return seen;
}

}  // namespace

std::optional<std::string> whyBlack(const LoadedScene& loaded, const Accel& accel,
                                    const RenderResult& result) {
  constexpr float kDark = 1e-4f;  // of the probe's mean
  constexpr double kMax = 0.8, kNearlyAll = 0.95;
  const Image mean = result.film.mean(), probe = loaded.probe.latLong();
  const float dark = kDark * luminance(Rgb(meanRadiance(probe)));
  const Seen seen = lookAround(loaded, accel, mean, dark);
  if (result.interrupted || seen.black == 0 || seen.black < kMax * seen.surfaces)
    return std::nullopt;
  const std::string what =
      fmt::format("{:.0f}% of what the camera sees is black: ", 100.0 * seen.black / seen.surfaces);
  const bool lets = std::any_of(loaded.scene.materials.begin(), loaded.scene.materials.end(),
                                [](const Material& m) { return m.backLetsLightThrough(); });
  if (!lets && 2 * seen.blackSingleSided > seen.black)
    return what +
           "single-sided walls, through which the camera may look, keep the light out; "
           "--single-sided light lets it in, and [[light]] in a scene file adds lamps";
  if (seen.black < kNearlyAll * seen.surfaces) return std::nullopt;
  return what + "no light reaches it; [[light]] in a scene file adds lamps";
}

std::optional<std::string> whyWhite(const RenderJob& job, const LoadedScene& loaded,
                                    const RenderResult& result) {
  const bool isShown = std::any_of(job.outputs.begin(), job.outputs.end(),
                                   [](const std::string& path) { return path.ends_with(".png"); });
  if (!isShown) return std::nullopt;
  const Image mean = result.film.mean();
  std::vector<float> brightest;
  size_t clipped = 0;
  for (int y = 0; y < mean.height; ++y)
    for (int x = 0; x < mean.width; ++x) {
      brightest.push_back(maxComponent(mean.rgb(x, y)));
      clipped += maxComponent(display(job.display, mean.rgb(x, y))) >= 1;
    }
  if (2 * clipped <= brightest.size()) return std::nullopt;
  const auto high = brightest.begin() + std::ptrdiff_t(brightest.size() * 9 / 10);
  std::nth_element(brightest.begin(), high, brightest.end());
  std::string hint =
      fmt::format("{:.0f}% of the .png's pixels are clipped; --exposure {:.0f} shows them",
                  100 * double(clipped) / double(brightest.size()), std::floor(-std::log2(*high)));
  if (!loaded.scene.lights.empty()) hint += ", --lights FACTOR dims the model's lights";
  return hint;
}

}  // namespace chromeball

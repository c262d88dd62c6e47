// SPDX-License-Identifier: Apache-2.0
#include "render_hints.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// Counts over a coarse grid of pixels.
struct Seen {
  int surfaces = 0;          // a surface is visible, from the front or back
  int black = 0;             // of these: the pixel is black
  int blackSingleSided = 0;  // of these: the surface is single-sided
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

// The likely cause if nearly every visible surface is black, or most are and single-sided.
std::optional<std::string> whyBlack(const RenderJob& job, const LoadedScene& loaded,
                                    const Accel& accel, const RenderResult& result) {
  constexpr float kDark = 1e-4f;  // of the probe's mean
  constexpr double kMax = 0.8, kNearlyAll = 0.95;
  const Image mean = result.film.mean(), probe = loaded.probe.latLong();
  const float dark = kDark * luminance(Rgb(meanRadiance(probe)));
  const Seen seen = lookAround(loaded, accel, mean, dark);
  if (result.interrupted || seen.black == 0 || seen.black < kMax * seen.surfaces)
    return std::nullopt;
  const std::string what = fmt::format("{:.0f}% of the visible surfaces are black: ",
                                       100.0 * seen.black / seen.surfaces);
  const auto scale = job.file.settings.get<std::vector<double>>("probe.scale");
  if (std::ranges::all_of(scale, [](double channel) { return channel == 0; }))
    return what + "--probe-scale 0 turns the probe off";
  const bool lets = std::any_of(loaded.scene.materials.begin(), loaded.scene.materials.end(),
                                [](const Material& m) { return m.backLetsLightThrough(); });
  if (!lets && 2 * seen.blackSingleSided > seen.black)
    return what +
           "single-sided walls, which the camera sees through, block the light; "
           "try --single-sided light, or add lamps with [[light]] in a scene file";
  if (seen.black < kNearlyAll * seen.surfaces) return std::nullopt;
  return what + "no light reaches them; add lamps with [[light]] in a scene file";
}

// The exposure to try if most pixels of a .png are clipped.
std::optional<std::string> whyWhite(const RenderJob& job, const LoadedScene& loaded,
                                    const RenderResult& result) {
  const bool hasPng = std::any_of(job.outputs.begin(), job.outputs.end(),
                                  [](const auto& path) { return lowerExtension(path) == ".png"; });
  if (!hasPng) return std::nullopt;
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
      fmt::format("{:.0f}% of the .png's pixels are clipped; try --exposure {:.0f}",
                  100 * double(clipped) / double(brightest.size()), std::floor(-std::log2(*high)));
  if (!loaded.scene.lights.empty()) hint += ", or dim the model's lights with --lights FACTOR";
  return hint;
}

void addDepthCut(const char* option, int depth, double fraction, Messages& messages) {
  constexpr double kMinFraction = 0.01;
  if (fraction > kMinFraction)
    messages.push_back({Message::Kind::Warning,
                        fmt::format("{} {} cut about {:.2g}% of the light; a higher one keeps it",
                                    option, depth, 100 * fraction)});
}

}  // namespace

void addExcluded(const RenderResult& result, Messages& messages) {
  const auto warning = [&](std::string text) {
    messages.push_back({Message::Kind::Warning, std::move(text)});
  };
  if (const InvalidSamples& invalid = result.invalid; invalid.total())
    warning(fmt::format(
        "{} invalid samples were left out ({} with a NaN, {} infinite, {} negative), the "
        "first at pixel ({}, {}); --aov invalid shows where",
        invalid.total(), invalid.of(Defect::Nan), invalid.of(Defect::Infinite),
        invalid.of(Defect::Negative), invalid.x, invalid.y));
  if (result.clamped.count)
    warning(fmt::format("--clamp scaled {} samples down, and removed {:.3g}% of the light of {}",
                        result.clamped.count, 100 * result.clamped.fractionRemoved(),
                        result.layers.empty() ? "the image" : "objects and differences"));
}

Messages resultMessages(const RenderJob& job, const LoadedScene& loaded,
                        const PreparedScene& prepared, const JobResult& result) {
  Messages messages;
  addExcluded(result.render, messages);
  const DepthCut& cut = result.render.depthCut;
  addDepthCut("--max-depth", job.settings.maxDepth, cut.fraction(cut.byDepth), messages);
  addDepthCut("--max-transmission-depth", job.settings.maxTransmissionDepth,
              cut.fraction(cut.byTransmission), messages);
  messages.insert(messages.end(), result.messages.begin(), result.messages.end());
  if (job.composite || job.settings.isPart()) return messages;
  if (job.settings.maxDepth > 0)  // at 0, only emitters are not black
    if (const auto why = whyBlack(job, loaded, prepared.world->accel, result.render))
      messages.push_back({Message::Kind::Warning, *why});
  if (const auto why = whyWhite(job, loaded, result.render))
    messages.push_back({Message::Kind::Note, *why});
  return messages;
}

}  // namespace chromeball

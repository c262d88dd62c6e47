// SPDX-License-Identifier: Apache-2.0
// The render loop: takes the samples of all pixels, in tiles, on all threads.
#pragma once

#include <atomic>
#include <cmath>

#include "base/progress.h"
#include "film/aov.h"
#include "film/film.h"
#include "film/layer_film.h"
#include "render/guide_training.h"
#include "render/render_settings.h"
#include "scene/camera.h"
#include "transport/integrator.h"

namespace chromeball {

class EnvironmentLight;
class IrradianceCache;
class RenderControl;

struct RenderResult {
  // A result with empty films. `layers`: the integrator's.
  RenderResult(const RenderSettings& settings, std::vector<Accumulation> layers);
  // Adds the samples of a part of the image, whose first pixel is this one's pixel (x, y).
  void add(const RenderResult& part, int x, int y) { addPixels(part, x, y), addTotals(part); }
  void addPixels(const RenderResult& part, int x, int y);  // thread-safe for different pixels
  void addTotals(const RenderResult& part);                // numbers that are not per pixel
  // Takes the pixels of a result with the same settings.
  void copyPixels(const RenderResult& from, const PixelRect& rect);
  // Only these pixels, with the names of the groups.
  RenderResult part(const PixelRect& rect) const;

  // The mean number of samples that pixels took.
  uint32_t samplesPerPixel() const {
    return adaptive ? uint32_t(std::lround(film.meanSampleCount())) : samples;
  }

  // Archives the totals, then the pixels in bands (film/rows.h).
  void archive(Archive& a);
  void archiveTotals(Archive& a);
  void archivePixels(Archive& a, Rows rows);

  Film film;
  AovFilm aovs;
  LayerFilm layers;                 // of the integrator
  std::vector<std::string> groups;  // names of the layers that are light groups
  FeatureFilm features;             // empty unless settings.wantsFeatures()
  RayCounts rays;
  DepthCut depthCut;
  InvalidSamples invalid;
  ClampedSamples clamped;
  uint32_t samples = 0;       // scheduled mean per pixel; 0: the first pass was interrupted
  bool isRepeated = false;    // all shards take these samples, and this is not the one to keep them
  bool adaptive = false;      // whether pixels took different numbers of samples
  size_t guidedRegions = 0;   // of the light guide; 0: light samples were not guided
  float causticFraction = 0;  // of bounces in caustics: guided (CausticGuide::fraction())
  bool interrupted = false;
  double overrun = 0;  // Schedule::overrun() at the end, with what preceded the passes

 private:
  RenderResult(const RenderResult& whole, const PixelRect& rect);
};

// Data that approximate renders use and that other renders may reuse.
struct RenderAids {
  const EnvironmentLight* environment = nullptr;  // the integrators that use it need one
  IrradianceCache* cache = nullptr;  // with RenderSettings::cacheError: gets missing records
};

// Renders until the limit of samples, time or noise is reached, or `stop` is set. Each pass covers
// the whole image; the first takes a few samples per pixel, each later one doubles them. The result
// does not depend on the number of threads (except under a time limit). `control`
// (render_state.h) may be null.
RenderResult render(const World& world, const Camera& camera, const LightSource& lighting,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop, RenderControl* control = nullptr,
                    const RenderAids& aids = {});

// The same for any integrator. `training`: trains the guides of its path tracers, if they have any.
RenderResult render(const Integrator& integrator, const World& world, const Camera& camera,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop, GuideTraining* training = nullptr,
                    RenderControl* control = nullptr);

}  // namespace chromeball

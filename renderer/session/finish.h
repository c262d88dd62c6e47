// SPDX-License-Identifier: Apache-2.0
// Turns the samples of a render into its image: the means, the layers, the composite. No scene is
// needed, so that parts of a render can be put together elsewhere (merge.h).
#pragma once

#include <atomic>

#include "base/archive.h"
#include "base/message.h"
#include "base/progress.h"
#include "composite/compose.h"
#include "composite/render_composite.h"
#include "image/io/write_image.h"
#include "render/render.h"
#include "session/denoised_image.h"

namespace chromeball {

// Statistics of a composite.
struct CompositeReport {
  double coverage = 0;           // mean alpha of the objects
  size_t darkerThanBlack = 0;    // number of pixels with negative results, which are set to 0
  struct Reflectance {           // of the local scene, estimated from the plate (reflectance.h)
    size_t pixels = 0;           // number of pixels that see the local scene
    double clampedFraction = 0;  // fraction of the pixels that need an albedo above 1
    double exposureRatio = 0;    // plate over the local scene with the model's own reflectance
    double lastChange = 0;       // mean |change| of the reflectance in the last iteration
  };
  std::optional<Reflectance> reflectance;
};

struct CompositeFinish {
  CompositeMode mode = CompositeMode::Difference;
  std::vector<std::string> layers;
  Image plate, reflectance;  // of the rendered part of the image; empty without such

  bool isShadowCatcher() const { return mode == CompositeMode::ShadowCatcher; }
};

// The inputs of the image besides the samples.
struct FinishPlan {
  RenderSettings settings;  // size, crop, layers of the first hit, hideProbe, denoise
  std::optional<CompositeFinish> composite;
  std::vector<std::string> groups = {};  // of light, if settings.wantsGroups()

  std::vector<Accumulation> layers() const;  // of the integrator
  // All but the composite's images, which are of the size of settings.window() or empty.
  void archive(Archive& a);
  void archiveImages(Archive& a);

 private:
  bool hasLayer(const std::string& name) const;  // whether there are data for this one
};

struct FinishedImage {
  OutputImage image;  // the color first, then the layers; no metadata
  ImageNoise noise;   // of the color, before denoising
  std::optional<CompositeReport> composite;
  std::optional<DenoiseReport> denoised;
};

// Denoises a whole image if the plan says so, also an interrupted render. If `stop` is set, it gets
// the layers that can be denoised later instead. `progress` receives fractions from kRenderShare to
// 1 then.
FinishedImage finish(const FinishPlan& plan, const RenderResult& result, const Progress& progress,
                     const std::atomic<bool>& stop);
// The same without denoising, and without the estimates from many pixels: the noise and the layer
// `variance`. `result` may cover a part of the image, unless it is a composite.
OutputImage imageOf(const FinishPlan& plan, const RenderResult& result);
// The same for a composite of two passes.
FinishedImage finishComposite(const FinishPlan& plan, const CompositeRender& render,
                              const Progress& progress, const std::atomic<bool>& stop);

}  // namespace chromeball

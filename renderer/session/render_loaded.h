// SPDX-License-Identifier: Apache-2.0
// Renders a description with a loaded scene: builds the acceleration structure and the lighting
// strategy, and calls the integrators.
#pragma once

#include <atomic>
#include <optional>

#include "approximate/environment_map.h"
#include "description/render_description.h"
#include "scene/gltf/model_cache.h"
#include "session/finish.h"
#include "session/load_scene.h"
#include "transport/world.h"

namespace chromeball {

// The data that a render needs besides the scene, which must outlive it.
struct PreparedScene {
  std::unique_ptr<const World> world;
  std::unique_ptr<LightSource> lighting;
  std::unique_ptr<const EnvironmentLight> environment;  // null: the integrator needs none
  double buildSeconds = 0, prepareSeconds = 0;          // of the world, of the lighting
};

// Throws InputError for a strategy that is unknown or does not suit the probe, and for light groups
// that take more memory than the description may. `earlier`: made from the same LoadedScene before
// its contents changed; what did not change is taken from it. Null: none.
PreparedScene prepareScene(const LoadedScene& loaded, const PreparedScene* earlier = nullptr);

// The plan for making the image from the description's samples.
FinishPlan finishPlan(const LoadedScene& loaded, const RenderResult& result);

struct FinishedRender : FinishedImage {
  RenderResult render;
  Messages messages = {};
  double seconds = 0;  // of rendering

  const Image& color() const { return image.layers.front().image; }  // linear RGB or RGBA
};

// When to end early: rendering, and then denoising what there is.
struct Stop {
  const std::atomic<bool>&rendering, &denoising;

  Stop(const std::atomic<bool>& both) : rendering(both), denoising(both) {}
  Stop(const std::atomic<bool>& render, const std::atomic<bool>& denoise)
      : rendering(render), denoising(denoise) {}
};

// Renders until the description's limit of samples, time or noise is reached, or `stop` says so. In
// the latter case render.interrupted is true, and the image contains the samples so far. `control`
// (render/render_state.h) may be null; not for composites of two passes.
FinishedRender renderLoaded(const LoadedScene& loaded, const PreparedScene& prepared,
                            const Progress& progress, const Stop& stop,
                            RenderControl* control = nullptr);

// The same without progress reports and interruption.
FinishedRender renderLoaded(const LoadedScene& loaded);

// The scenes of successive frames: what does not change is loaded and built once.

class FrameScene {
 public:
  // Loads and builds the scene of a description. All descriptions must be alike but for their
  // times, `orbit`, and the probe's file and rotation. Files are opened, images decoded, and the
  // tables of the probe made for the first; meshes, and the acceleration structures over them, are
  // made again where they have moved or changed, the probe where it has turned, and everything for
  // composites. Throws InputError.
  void show(const RenderDescription& description);

  const LoadedScene& loaded() const { return *loaded_; }
  const PreparedScene& prepared() const { return prepared_; }

 private:
  void load(const RenderDescription& description);

  ModelCache models_;
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
};

// The part of a time limit that is kept for what follows the samples.

// The settings with the time limit of the samples alone. From the limit is taken what denoising
// takes, by the time of a small image, and writing the description's files; at most three quarters
// of it. Without a limit, or a file to write, the settings as they are.
struct KeptTime {
  RenderSettings settings;
  double seconds = 0;
};
KeptTime keepTime(const RenderDescription& description);

}  // namespace chromeball

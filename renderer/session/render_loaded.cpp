// SPDX-License-Identifier: Apache-2.0
#include "session/render_loaded.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "session/cache_file.h"
#include "session/memory_estimate.h"
#include "session/run_composite.h"
#include "session/scene_lighting.h"
#include "transport/light_groups.h"

namespace chromeball {
namespace {

FinishedRender renderPlain(const LoadedScene& loaded, const PreparedScene& prepared,
                           const RenderSettings& settings, const Progress& progress,
                           const Stop& stop, RenderControl* control) {
  const RenderDescription& description = loaded.description;
  const double share = description.settings.denoisesAtEnd() ? kRenderShare : 1;
  std::optional<CacheFile> records;
  if (description.settings.cacheError) records.emplace(loaded);
  RenderResult result =
      render(*prepared.world, loaded.camera, *prepared.lighting, settings,
             [&](double fraction) { progress(share * fraction); }, stop.rendering, control,
             {prepared.environment.get(), records ? &records->cache() : nullptr});
  if (records) records->write();
  FinishedImage finished = finish(finishPlan(loaded, result), result, progress, stop.denoising);
  return {std::move(finished), std::move(result)};
}

// The part of an image of the whole size that the description renders.
Image cropped(const Image& whole, const Crop& window) {
  Image part(window.width, window.height, whole.channels);
  for (int y = 0; y < window.height; ++y)
    std::copy_n(whole.at(window.x, window.y + y), window.width * whole.channels, part.at(0, y));
  return part;
}

// The number of groups is known only now.
void checkGroupMemory(const LoadedScene& loaded, const World& world, const LightSource& lighting) {
  const RenderDescription& description = loaded.description;
  const size_t count = LightGroups(world, lighting).names().size();
  const Crop window = description.settings.window();
  const double layers = double(LayerFilm::bytesPerPixel(count, false) + 2 * count * sizeof(Rgb)) *
                        window.width * window.height;
  const double needed = estimateMemory(loaded).peak + layers;
  checkMemory(description, needed,
              "{}: {} light groups take {:.3g} GB of memory, with all else {:.3g} GB",
              description.origins.of("output.aovs"), count, 1e-9 * layers, 1e-9 * needed);
}

}  // namespace

FinishPlan finishPlan(const LoadedScene& loaded, const RenderResult& result) {
  const RenderDescription& description = loaded.description;
  FinishPlan plan{description.settings, {}, result.groups};
  if (!description.composite) return plan;
  const Crop window = description.settings.window();
  plan.composite = {description.composite->mode, description.composite->layers, {}, {}};
  if (!description.composite->plate.empty())
    plan.composite->plate = cropped(description.composite->plate, window);
  if (loaded.projection) plan.composite->reflectance = cropped(loaded.projection->colors(), window);
  return plan;
}

PreparedScene prepareScene(const LoadedScene& loaded, const PreparedScene* earlier) {
  const RenderDescription& description = loaded.description;
  Stopwatch watch;
  PreparedScene prepared;
  const std::vector<RayMask> masks =
      description.composite ? rayMasks(loaded.isObject) : std::vector<RayMask>();
  if (earlier) {
    BsdfTables tables = earlier->world->bsdfTables;
    tables.complete(loaded.scene.materials, description.settings.regularize);
    prepared.world =
        std::make_unique<const World>(loaded.scene, masks, tables, earlier->world->accel.built());
  } else {
    prepared.world = std::make_unique<const World>(
        loaded.scene, masks, BsdfTables(loaded.scene.materials, description.settings.regularize));
  }
  prepared.buildSeconds = watch.lap();
  prepared.lighting = makeLighting(loaded);
  prepared.environment =
      makeEnvironment(description.settings.integrator, description.lighting.strategy, loaded);
  if (description.settings.wantsGroups())
    checkGroupMemory(loaded, *prepared.world, *prepared.lighting);
  prepared.prepareSeconds = watch.lap();
  loaded.scene.checkTexels();
  return prepared;
}

FinishedRender renderLoaded(const LoadedScene& loaded, const PreparedScene& prepared,
                            const Progress& progress, const Stop& stop, RenderControl* control) {
  const RenderDescription& description = loaded.description;
  Stopwatch watch;
  const KeptTime kept = keepTime(description);
  FinishedRender result =
      description.composite
          ? renderComposite(loaded, prepared, kept.settings, progress, stop, control)
          : renderPlain(loaded, prepared, kept.settings, progress, stop, control);
  loaded.scene.checkTexels();
  result.render.interrupted |= description.settings.denoisesAtEnd() && !result.denoised;
  result.seconds = watch.lap();
  if (constexpr double kNotable = 0.05; kept.seconds > kNotable)
    addNote(result.messages, "{}: {:.3g} s of it were kept for {}writing",
            description.origins.of("render.time"), kept.seconds,
            description.settings.denoisesAtEnd() ? "denoising and " : "");
  if (result.render.overrun > 0)
    addWarning(
        result.messages,
        "{}: the first pass, which is always completed, took {:.3g} s, longer than {:.3g} s{}",
        description.origins.of("render.time"), result.render.overrun, *kept.settings.timeLimit,
        kept.seconds > 0
            ? fmt::format(", which {:g} s leave for the samples", *description.settings.timeLimit)
            : "");
  return result;
}

FinishedRender renderLoaded(const LoadedScene& loaded) {
  const std::atomic<bool> never = false;
  return renderLoaded(
      loaded, prepareScene(loaded), [](double) {}, never);
}

void FrameScene::show(const RenderDescription& description) {
  if (!loaded_ || description.composite || !isViewOf(description, loaded_->scene, loaded_->view))
    return load(description);
  const FrameChange change = loadFrame(description, *loaded_, models_);
  if (change.geometry) {
    BsdfTables tables = prepared_.world->bsdfTables;
    tables.complete(loaded_->scene.materials, description.settings.regularize);
    const std::shared_ptr<BuiltGeometry> built = prepared_.world->accel.built();
    prepared_.world.reset();
    prepared_.world =
        std::make_unique<const World>(loaded_->scene, std::vector<RayMask>(), tables, built);
  }
  if (!change.lighting) return;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment =
      makeEnvironment(description.settings.integrator, description.lighting.strategy, *loaded_);
}

void FrameScene::load(const RenderDescription& description) {
  const std::optional<AutomaticView> view = loaded_ ? std::optional(loaded_->view) : std::nullopt;
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ =
      std::make_unique<LoadedScene>(loadScene(description, &models_, view ? &*view : nullptr));
  prepared_ = prepareScene(*loaded_);
}

}  // namespace chromeball

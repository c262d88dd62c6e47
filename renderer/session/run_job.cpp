// SPDX-License-Identifier: Apache-2.0
#include "session/run_job.h"

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

JobResult renderPlain(const LoadedScene& loaded, const PreparedScene& prepared,
                      const Progress& progress, const std::atomic<bool>& stop,
                      RenderControl* control) {
  const RenderDescription& job = loaded.description;
  const double share = job.settings.denoisesAtEnd() ? kRenderShare : 1;
  std::optional<CacheFile> records;
  if (job.settings.cacheError) records.emplace(loaded);
  RenderResult result = render(*prepared.world, loaded.camera, *prepared.lighting, job.settings,
                               [&](double fraction) { progress(share * fraction); }, stop, control,
                               {prepared.environment.get(), records ? &records->cache() : nullptr});
  if (records) records->write();
  FinishedImage finished = finish(finishPlan(loaded, result), result, progress, stop);
  return {std::move(finished), std::move(result)};
}

// The part of an image of the whole size that the job renders.
Image cropped(const Image& whole, const Crop& window) {
  Image part(window.width, window.height, whole.channels);
  for (int y = 0; y < window.height; ++y)
    std::copy_n(whole.at(window.x, window.y + y), window.width * whole.channels, part.at(0, y));
  return part;
}

// The number of groups is known only now.
void checkGroupMemory(const LoadedScene& loaded, const World& world, const LightSource& lighting) {
  const RenderDescription& job = loaded.description;
  const size_t count = LightGroups(world, lighting).names().size();
  const Crop window = job.settings.window();
  const double layers = double(LayerFilm::bytesPerPixel(count, false) + 2 * count * sizeof(Rgb)) *
                        window.width * window.height;
  const double needed = estimateMemory(loaded).peak + layers;
  if (needed > memoryLimit(job))
    throw InputError(
        fmt::format("{}: {} light groups take {:.3g} GB of memory, with all else {:.3g} GB; the "
                    "limit is {:.3g} GB",
                    job.origins.of("output.aovs"), count, 1e-9 * layers, 1e-9 * needed,
                    1e-9 * memoryLimit(job)),
        Remedy{"memory", {}});
}

}  // namespace

FinishPlan finishPlan(const LoadedScene& loaded, const RenderResult& result) {
  const RenderDescription& job = loaded.description;
  FinishPlan plan{job.settings, {}, result.groups};
  if (!job.composite) return plan;
  const Crop window = job.settings.window();
  plan.composite = {job.composite->mode, job.composite->layers, {}, {}};
  if (!job.composite->plate.empty()) plan.composite->plate = cropped(job.composite->plate, window);
  if (loaded.projection) plan.composite->reflectance = cropped(loaded.projection->colors(), window);
  return plan;
}

PreparedScene prepareScene(const LoadedScene& loaded, const PreparedScene* earlier) {
  const RenderDescription& job = loaded.description;
  Stopwatch watch;
  PreparedScene prepared;
  const std::vector<RayMask> masks =
      job.composite ? rayMasks(loaded.isObject) : std::vector<RayMask>();
  if (earlier) {
    BsdfTables tables = earlier->world->bsdfTables;
    tables.complete(loaded.scene.materials, job.settings.regularize);
    prepared.world =
        std::make_unique<const World>(loaded.scene, masks, tables, earlier->world->accel.built());
  } else {
    prepared.world = std::make_unique<const World>(
        loaded.scene, masks, BsdfTables(loaded.scene.materials, job.settings.regularize));
  }
  prepared.buildSeconds = watch.lap();
  prepared.lighting = makeLighting(loaded);
  prepared.environment = makeEnvironment(job.settings.integrator, job.lighting.strategy, loaded);
  if (job.settings.wantsGroups()) checkGroupMemory(loaded, *prepared.world, *prepared.lighting);
  prepared.prepareSeconds = watch.lap();
  loaded.scene.checkTexels();
  return prepared;
}

JobResult renderJob(const LoadedScene& loaded, const PreparedScene& prepared,
                    const Progress& progress, const std::atomic<bool>& stop,
                    RenderControl* control) {
  const RenderDescription& job = loaded.description;
  Stopwatch watch;
  JobResult result = job.composite ? renderComposite(loaded, prepared, progress, stop, control)
                                   : renderPlain(loaded, prepared, progress, stop, control);
  loaded.scene.checkTexels();
  result.render.interrupted |= job.settings.denoisesAtEnd() && !result.denoised;
  result.seconds = watch.lap();
  if (result.render.overrun > 0)
    result.messages.push_back(
        {Message::Kind::Warning,
         fmt::format(
             "{}: the first pass, which is always completed, took {:.2g} s, longer than {:g}",
             job.origins.of("render.time"), result.render.overrun, *job.settings.timeLimit)});
  return result;
}

JobResult renderJob(const LoadedScene& loaded) {
  const std::atomic<bool> never = false;
  return renderJob(
      loaded, prepareScene(loaded), [](double) {}, never);
}

void FrameScene::show(const RenderDescription& job) {
  if (!loaded_ || job.composite) return load(job);
  const FrameChange change = loadFrame(job, *loaded_, models_);
  if (change.geometry) {
    BsdfTables tables = prepared_.world->bsdfTables;
    tables.complete(loaded_->scene.materials, job.settings.regularize);
    const std::shared_ptr<BuiltGeometry> built = prepared_.world->accel.built();
    prepared_.world.reset();
    prepared_.world =
        std::make_unique<const World>(loaded_->scene, std::vector<RayMask>(), tables, built);
  }
  if (!change.lighting) return;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment = makeEnvironment(job.settings.integrator, job.lighting.strategy, *loaded_);
}

void FrameScene::load(const RenderDescription& job) {
  const std::optional<AutomaticView> view = loaded_ ? std::optional(loaded_->view) : std::nullopt;
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ = std::make_unique<LoadedScene>(loadScene(job, &models_, view ? &*view : nullptr));
  prepared_ = prepareScene(*loaded_);
}

}  // namespace chromeball

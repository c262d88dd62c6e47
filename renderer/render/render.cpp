// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <algorithm>
#include <cassert>
#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "film/rows.h"
#include "render/guide_training.h"
#include "render/pixel_renderer.h"
#include "render/render_state.h"

namespace chromeball {
namespace {

constexpr double kRaysOfHit = 3;  // of a path from a camera ray that hits something; on average

class Renderer {
 public:
  Renderer(const Integrator& integrator, const World& world, const Camera& camera,
           const RenderSettings& settings, RenderState& state, LiveResult* live)
      : integrator_(integrator),
        world_(world),
        camera_(camera),
        settings_(settings),
        state_(state),
        live_(live),
        tiles_{settings.window().width, settings.window().height},
        pixels_(integrator, world, camera, settings, state.result),
        workers_([this] { return pixels_.makeWorker(); }) {}

  void tracePhotons() {
    if (state_.training) state_.training->tracePhotons(1 + kRaysOfHit * pixels_.fractionOfHits());
  }

  // Starts the pass that raises the image's mean number of samples per pixel to `wanted`.
  void startPass(uint32_t wanted) {
    const auto lock = lockLive();
    RenderResult& result = state_.result;
    if (state_.schedule.endsPilot()) {
      state_.allocation.emplace(result.film.errors(), state_.done, leastRate());
    }
    state_.wanted = wanted;
    state_.finished.assign(tiles_.count(), 0);
    GuideTraining* training = state_.training;
    trains_ = training && training->startPass(state_.done, wanted);
    if (training && !trains_ && state_.done > 0) training->end(result.film.errors(), state_.done);
    if (result.isRepeated && state_.done >= settings_.shard.repeated) forgetRepeated();
    result.adaptive = state_.allocation.has_value();
  }

  // Renders tiles that the pass has not finished, until there are none or `isDone`. `progress`
  // receives the fraction of the pass.
  void renderTiles(const Progress& progress, const std::function<bool()>& isDone) {
    std::vector<uint32_t> open;
    for (uint32_t tile = 0; tile < tiles_.count(); ++tile)
      if (!state_.finished[tile]) open.push_back(tile);
    const Beam beam = beamOfPass(state_.wanted);
    std::atomic<size_t> finished = tiles_.count() - open.size();
    std::mutex reporting;
    parallelRanges(open.size(), 1, [&](size_t begin, size_t end) {
      PixelWorker& worker = workers_.local();
      for (size_t i = begin; i < end && !isDone(); ++i) {
        renderTile(worker, open[i], beam);
        const size_t count = ++finished;
        if (std::unique_lock lock(reporting, std::try_to_lock); lock)
          progress(double(count) / double(tiles_.count()));
      }
    });
    gather();
  }

  bool hasFinishedPass() const {
    return std::ranges::all_of(state_.finished, [](uint8_t done) { return done == 1; });
  }

  void endPass() {
    const auto lock = lockLive();
    RenderResult& result = state_.result;
    if (trains_)
      if (const auto weight = state_.training->learnLights(state_.wanted);
          weight && result.layers.empty()) {  // layers have no weights, and must fit the film
        if (live_) live_->replaced();
        result.film.weigh(*weight);
        result.features.weigh(*weight);
      }
    trains_ = false;
    state_.done = state_.wanted;
    result.samples = settings_.shard.kept(state_.done);
    state_.finished.clear();
  }

 private:
  // Nobody watches as long as the lock exists.
  std::unique_lock<std::mutex> lockLive() {
    return live_ ? live_->lock() : std::unique_lock<std::mutex>();
  }

  void renderTile(PixelWorker& worker, size_t tile, const Beam& beam) {
    const uint32_t taught = state_.training ? state_.training->taught() : 0;
    if (live_) live_->beginTile(tile);
    tiles_.forPixels(tile, [&](int x, int y) {
      const uint64_t pixel = uint64_t(y) * uint64_t(tiles_.width) + uint64_t(x);
      worker.context.records = trains_ ? state_.training->recordsOf(tile, pixel) : nullptr;
      pixels_.render(worker, x, y, countOf(x, y, state_.done), countOf(x, y, state_.wanted), beam,
                     taught);
      if (trains_) pixels_.finish(worker);  // records are of one pixel
    });
    pixels_.finish(worker);
    if (live_) live_->endTile(tile);
    world_.scene.checkTexels();
    state_.finished[tile] = 1;
  }

  // The filter width of textures depends on the final number of samples per pixel. If a time or
  // noise limit leaves that open, the number after this pass is used.
  Beam beamOfPass(uint32_t wanted) const {
    if (world_.scene.textures.empty()) return {};
    const bool open = settings_.timeLimit || settings_.noiseLimit;
    return beamOf(camera_, settings_.height, open ? wanted : settings_.samplesOfAll());
  }

  // Samples of the pixel of all shards when this one has taken `taken` per pixel.
  uint32_t countOf(int x, int y, uint32_t taken) const {
    const uint32_t mean = settings_.shard.ofAll(taken);
    return state_.allocation ? state_.allocation->count(x, y, mean) : mean;
  }

  // These samples only served for learning, and for fractions of the light.
  void forgetRepeated() {
    if (live_) live_->replaced();
    RenderResult own(settings_, integrator_.layers());
    own.rays = state_.result.rays;
    own.depthCut = state_.result.depthCut;
    own.clamped = state_.result.clamped;
    own.clamped.count = 0;
    own.groups = std::move(state_.result.groups);
    state_.result = std::move(own);
  }

  // The least rate for which every pixel of a shard has a sample of each half; under limits, after
  // some passes.
  float leastRate() const {
    const Shard& shard = settings_.shard;
    if (shard.count == 1) return 0;
    if (settings_.timeLimit || settings_.noiseLimit) return 1.0f / 16;
    return 2 * float(shard.count) / float(std::max(1u, shard.samplesOfAll - shard.repeated));
  }

  // Moves what the threads have counted to the result.
  void gather() {
    const auto lock = lockLive();
    RenderResult& result = state_.result;
    workers_.forEach([&](PixelWorker& worker) {
      result.rays.add(std::exchange(worker.context.counts, {}));
      // Sums of light are those of the image only while all pixels have as many samples.
      const DepthCut cut = std::exchange(worker.context.depthCut, {});
      ClampedSamples clamped = worker.context.clamp.takeClamped();
      if (state_.allocation)
        clamped.forgetLight();
      else
        result.depthCut.add(cut);
      result.clamped.add(clamped);
      result.invalid.add(std::exchange(worker.invalid, {}));
    });
  }

  const Integrator& integrator_;
  const World& world_;
  const Camera& camera_;
  const RenderSettings& settings_;
  RenderState& state_;
  LiveResult* live_;  // null: nobody watches
  TileGrid tiles_;
  PixelRenderer pixels_;
  PerThread<PixelWorker> workers_;
  bool trains_ = false;  // the pass in progress is part of the guides' training
};

// Renders passes until the schedule ends or `stop` is set.
void renderPasses(Renderer& renderer, RenderState& state, const Progress& progress,
                  const std::atomic<bool>& stop, RenderControl* control) {
  RenderResult& result = state.result;
  while (!stop) {
    if (state.finished.empty()) {
      const uint32_t wanted = state.schedule.next(state.done, result.film);
      if (wanted <= state.done) {
        result.overrun = state.schedule.overrun(state.done);
        return progress(1);  // the rest was only an estimate
      }
      renderer.startPass(wanted);
    }
    const auto pauses = [&] { return control && control->wantsPause(state); };
    const double from = state.done, samples = state.wanted - from;
    renderer.renderTiles(
        [&](double fraction) { progress(state.schedule.progress(from + fraction * samples)); },
        [&] { return stop || pauses(); });
    if (renderer.hasFinishedPass()) {
      renderer.endPass();
      if (control) control->endPass(state);
    }
    if (!stop && pauses()) control->pause(state);
  }
  result.interrupted = true;
}

}  // namespace

RenderResult::RenderResult(const RenderSettings& settings, std::vector<Accumulation> layerKinds)
    : film(settings.window().width, settings.window().height),
      aovs(settings.window().width, settings.window().height, settings.aovs),
      layers(settings.window().width, settings.window().height, std::move(layerKinds),
             settings.wantsFeatures()),
      features(settings.window().width, settings.window().height, settings.wantsFeatures()) {}

void RenderResult::addPixels(const RenderResult& part, int x, int y) {
  film.add(part.film, x, y);
  aovs.add(part.aovs, x, y);
  layers.add(part.layers, x, y);
  features.add(part.features, x, y);
}

void RenderResult::addTotals(const RenderResult& part) {
  rays.add(part.rays);
  depthCut.add(part.depthCut);
  invalid.add(part.invalid);
  clamped.add(part.clamped);
  adaptive |= part.adaptive;
  guidedRegions += part.guidedRegions;
  causticFraction = std::max(causticFraction, part.causticFraction);
  interrupted |= part.interrupted;
  overrun = std::max(overrun, part.overrun);
}

void RenderResult::copyPixels(const RenderResult& from, const PixelRect& rect) {
  film.copyPixels(from.film, rect);
  aovs.copyPixels(from.aovs, rect);
  layers.copyPixels(from.layers, rect);
  features.copyPixels(from.features, rect);
}

RenderResult::RenderResult(const RenderResult& whole, const PixelRect& rect)
    : film(whole.film.part(rect)),
      aovs(whole.aovs.part(rect)),
      layers(whole.layers.part(rect)),
      groups(whole.groups),
      features(whole.features.part(rect)) {}

RenderResult RenderResult::part(const PixelRect& rect) const { return {*this, rect}; }

void RenderResult::archive(Archive& a) {
  archiveTotals(a);
  const Bands bands{film.width(), film.height()};
  a.blocks(bands.count(),
           [&](Archive& block, size_t band) { archivePixels(block, bands.rows(band)); });
}

void RenderResult::archiveTotals(Archive& a) {
  a(rays);
  a(depthCut);
  a(invalid);
  a(clamped);
  a(samples);
  a(isRepeated);
  a(adaptive);
  a(guidedRegions);
  a(causticFraction);
  bool isWeighed = film.isWeighed();
  a(isWeighed);
  if (isWeighed) film.beWeighed();
}

void RenderResult::archivePixels(Archive& a, Rows rows) {
  film.archive(a, rows);
  aovs.archive(a, rows);
  layers.archive(a, rows);
  features.archive(a, rows);
}

RenderResult render(const Integrator& integrator, const World& world, const Camera& camera,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop, GuideTraining* training,
                    RenderControl* control) {
  RenderState state{.result = RenderResult(settings, integrator.layers()),
                    .finished = {},
                    .allocation = {},
                    .schedule = Schedule(settings),
                    .training = training};
  LiveResult* const live = control ? control->live() : nullptr;
  Renderer renderer(integrator, world, camera, settings, state, live);
  state.result.groups = integrator.groups();
  state.result.isRepeated = settings.shard.index > 0 && settings.shard.repeated > 0;
  if (!control || !control->restore(state)) {
    StopMonitor monitor(stop);
    const MonitoredWork work(&monitor);
    try {
      renderer.tracePhotons();
    } catch (const Interrupted&) {  // no pass begins
    }
  }
  if (live) live->begin(state.result);
  try {
    renderPasses(renderer, state, progress, stop, control);
  } catch (...) {
    if (live) live->end();
    throw;
  }
  if (live) live->end();
  RenderResult& result = state.result;
  if (training) {
    result.guidedRegions = training->lights().guidedRegions();
    result.causticFraction = training->caustics().empty() ? 0 : training->caustics().fraction();
  }
  // A render of few samples ends within the training, and may be continued.
  if (control && training && !result.interrupted) training->end(result.film.errors(), state.done);
  if (control && state.canBeStored()) control->end(state);
  return std::move(state.result);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "integrate/render.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>

#include "film/allocation.h"
#include "integrate/guide_training.h"
#include "integrate/path_batch.h"
#include "integrate/regularization.h"
#include "integrate/schedule.h"
#include "integrate/tile_grid.h"

namespace chromeball {
namespace {

constexpr uint32_t kLargestTable = 4096;  // samples of a half that share one randomisation
// Deeper vertices contribute too little to profit from stratification; they use independent random
// numbers.
constexpr int kTabulatedVertices = 6;

constexpr double kRaysOfHit = 3;  // of a path from a camera ray that hits something; on average

// How many of a pixel's first `samples` samples belong to the half.
uint32_t samplesOf(int half, uint32_t samples) {
  return samples / 2 + (half == 0 ? samples % 2 : 0);
}

// An adaptive render takes several times the mean in some pixels.
uint32_t tableSize(const RenderSettings& settings) {
  const uint64_t samples = uint64_t(samplesOf(0, settings.samples)) * (settings.adaptive ? 4 : 1);
  return uint32_t(std::bit_ceil(std::min<uint64_t>(samples, kLargestTable)));
}

struct Worker {
  PathContext context;
  InvalidSamples invalid;
};

class Renderer {
 public:
  // `training` may be null.
  Renderer(const Integrator& integrator, const World& world, const Camera& camera,
           const RenderSettings& settings, GuideTraining* training, RenderResult& result)
      : integrator_(integrator),
        world_(world),
        camera_(camera),
        cameraRays_(camera, float(settings.width) / float(settings.height)),
        settings_(settings),
        training_(training),
        result_(result),
        table_(tableSize(settings),
               dimension::kVertex + dimension::kPerVertex *
                                        (std::min(settings.maxDepth, kTabulatedVertices - 1) + 1),
               settings.seed),
        workers_([this] {
          return Worker{{.sampler = PixelSampler(table_, settings_.seed),
                         .clamp = Clamp(settings_.clamp),
                         .layers = std::vector<Rgb>(integrator_.layers().size())}};
        }) {}

  // Of the camera rays through a grid of points, those that hit something.
  double fractionOfHits() const {
    constexpr int kPoints = 32;
    int hits = 0;
    for (int i = 0; i < kPoints * kPoints; ++i) {
      const float u = (float(i % kPoints) + 0.5f) / kPoints;
      const float v = (float(i / kPoints) + 0.5f) / kPoints;
      Ray ray;
      cameraRays_.ray(u, v, ray.origin, ray.direction);
      Hit hit;
      hits += world_.accel.intersect(ray, uint32_t(i), hit, integrator_.visible());
    }
    return double(hits) / (kPoints * kPoints);
  }

  // From here on, each pixel takes samples by the noise around it so far.
  void adapt(uint32_t done) {
    allocation_.emplace(result_.film.errors(), done);
    result_.adaptive = true;
  }

  // Raises the image's mean number of samples per pixel from `done` to `wanted`. `progress`
  // receives the fraction of the pass.
  void pass(uint32_t done, uint32_t wanted, const Progress& progress,
            const std::atomic<bool>& stop) {
    const Beam beam = beamOfPass(wanted);
    const TileGrid tiles{settings_.width, settings_.height};
    const bool trains = training_ && training_->startPass(done, wanted);
    if (training_ && !trains && done > 0) training_->end(result_.film.errors(), done);
    std::atomic<size_t> finished = 0;
    std::mutex reporting;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, tiles.count(), 1),
        [&](const tbb::blocked_range<size_t>& range) {
          Worker& worker = workers_.local();
          for (size_t tile = range.begin(); tile < range.end() && !stop; ++tile) {
            tiles.forPixels(tile, [&](int x, int y) {
              const uint32_t from = countOf(x, y, done), to = countOf(x, y, wanted);
              worker.context.records =
                  trains ? training_->recordsOf(tile, pixelIndex(x, y)) : nullptr;
              for (int half = 0; half < Film::kHalves; ++half)
                renderHalf(worker, x, y, half, from, to, beam);
            });
            const size_t count = ++finished;
            if (std::unique_lock lock(reporting, std::try_to_lock); lock)
              progress(double(count) / double(tiles.count()));
          }
        },
        tbb::simple_partitioner());
    if (trains && !stop)
      if (const auto weight = training_->learnLights()) {
        result_.film.weigh(*weight);
        result_.features.weigh(*weight);
      }
  }

  void gather() {
    for (const Worker& worker : workers_) {
      result_.rays.add(worker.context.counts);
      result_.depthCut.add(worker.context.depthCut);
      result_.invalid.add(worker.invalid);
      result_.clamped.add(worker.context.clamp.clamped());
    }
  }

 private:
  // The filter width of textures depends on the final number of samples per pixel. If a time or
  // noise limit leaves that open, the number after this pass is used.
  Beam beamOfPass(uint32_t wanted) const {
    if (world_.scene.textures.empty()) return {};
    const bool open = settings_.timeLimit || settings_.noiseLimit;
    return beamOf(camera_, settings_.height, open ? wanted : settings_.samples);
  }

  uint64_t pixelIndex(int x, int y) const {
    return uint64_t(y) * uint64_t(settings_.width) + uint64_t(x);
  }

  uint32_t countOf(int x, int y, uint32_t mean) const {
    return allocation_ ? allocation_->count(x, y, mean) : mean;
  }

  // Generates and traces the camera rays of consecutive samples.
  void traceCameraRays(PixelSampler& sampler, uint32_t firstSample,
                       std::span<CameraSample> cameras) const {
    std::array<Ray, PathBatch::kMaxPaths> rays;
    std::array<uint32_t, PathBatch::kMaxPaths> keys;
    std::array<std::optional<Hit>, PathBatch::kMaxPaths> hits;
    const size_t count = cameras.size();
    for (size_t i = 0; i < count; ++i) {
      sampler.startSample(firstSample + uint32_t(i));
      const vec2 offset = sampler.get2(dimension::kPixel);
      const float u = (float(cameras[i].x) + offset.x) / float(settings_.width);
      const float v = (float(cameras[i].y) + offset.y) / float(settings_.height);
      Ray& ray = rays[i];
      if (cameraRays_.hasLens())
        cameraRays_.ray(u, v, sampler.get2(dimension::kLens), ray.origin, ray.direction);
      else
        cameraRays_.ray(u, v, ray.origin, ray.direction);
      keys[i] = sampler.sampleKey();
    }
    world_.accel.intersect(std::span(rays).first(count), std::span(keys).first(count),
                           Accel::Coherence::High, std::span(hits).first(count),
                           integrator_.visible());
    for (size_t i = 0; i < count; ++i) {
      cameras[i].ray = rays[i];
      cameras[i].hit = hits[i];
    }
  }

  // Takes those of the pixel's samples [done, wanted) that belong to `half`. Beyond the table's
  // size, the table is used again with another randomisation.
  void renderHalf(Worker& worker, int x, int y, int half, uint32_t done, uint32_t wanted,
                  const Beam& beam) {
    const uint32_t end = samplesOf(half, wanted);
    for (uint32_t begin = samplesOf(half, done); begin < end;) {
      const uint32_t table = begin / table_.size(), first = begin % table_.size();
      const uint32_t count = std::min(end - begin, table_.size() - first);
      worker.context.sampler.startPixel(uint32_t(x), uint32_t(y),
                                        Film::kHalves * uint64_t(table) + uint64_t(half));
      result_.film.add(x, y, half,
                       renderSamples(worker, {x, y, half, table}, first, first + count, beam));
      begin += count;
    }
  }

  // Samples of a half of a pixel that share a randomisation of the table.
  struct Block {
    int x, y, half;
    uint32_t table;
  };

  // Takes samples [begin, end) of the sampler's table.
  SampleSums renderSamples(Worker& worker, const Block& block, uint32_t begin, uint32_t end,
                           const Beam& beam) {
    SampleSums sums;
    std::array<CameraSample, PathBatch::kMaxPaths> cameras;
    std::array<FirstHit, PathBatch::kMaxPaths> firsts;
    const bool wantsFirst = !result_.aovs.empty() || !result_.features.empty();
    for (uint32_t i = begin; i < end; i += PathBatch::kMaxPaths) {
      const size_t count = std::min<size_t>(end - i, PathBatch::kMaxPaths);
      for (size_t k = 0; k < count; ++k) {
        firsts[k] = {};
        cameras[k] = {.x = block.x,
                      .y = block.y,
                      .half = block.half,
                      .ray = {},
                      .hit = {},
                      .beam = beam,
                      .widening = wideningOf(block, i + uint32_t(k)),
                      .first = wantsFirst ? &firsts[k] : nullptr};
      }
      const auto taken = std::span(cameras).first(count);
      traceCameraRays(worker.context.sampler, i, taken);
      renderBatch(worker, taken, i, sums);
    }
    return sums;
  }

  float wideningOf(const Block& block, uint32_t i) const {
    if (!settings_.regularize) return 0;
    return regularizationWidth(Film::kHalves * (block.table * table_.size() + i) +
                               uint32_t(block.half));
  }

  void renderBatch(Worker& worker, std::span<const CameraSample> cameras, uint32_t firstSample,
                   SampleSums& sums) {
    std::array<Sample, PathBatch::kMaxPaths> samples;
    std::vector<Rgb>& layers = worker.context.layers;
    const bool hasLayers = !layers.empty();  // of one sample at a time
    if (!hasLayers) integrator_.sampleMany(cameras, firstSample, worker.context, samples);
    for (size_t k = 0; k < cameras.size(); ++k) {
      if (hasLayers) {
        std::fill(layers.begin(), layers.end(), Rgb(0));
        worker.context.sampler.startSample(firstSample + uint32_t(k));
        samples[k] = integrator_.sample(cameras[k], worker.context);
      }
      add(worker, cameras[k], samples[k], sums);
    }
  }

  void add(Worker& worker, const CameraSample& camera, const Sample& sample, SampleSums& sums) {
    const int x = camera.x, y = camera.y, half = camera.half;
    if (sample.defect) {
      worker.invalid.add(*sample.defect, x, y);
      result_.aovs.add(x, y, *sample.defect);
    } else {
      sums.add(sample.radiance);
      if (!result_.layers.empty()) result_.layers.add(x, y, half, worker.context.layers);
    }
    if (camera.first) {
      camera.first->depth = cameraRays_.depth(camera.ray.direction, camera.first->depth);
      if (!result_.aovs.empty()) result_.aovs.add(x, y, *camera.first);
      if (!result_.features.empty() && !sample.defect)
        result_.features.add(x, y, half, *camera.first, sample.radiance);
    }
  }

  const Integrator& integrator_;
  const World& world_;
  const Camera& camera_;
  CameraRays cameraRays_;
  const RenderSettings& settings_;
  GuideTraining* training_;
  RenderResult& result_;
  SobolTable table_;
  std::optional<SampleAllocation> allocation_;  // none: the same number of samples everywhere
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace

RenderResult render(const Integrator& integrator, const World& world, const Camera& camera,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop, GuideTraining* training) {
  RenderResult result{
      .film = Film(settings.width, settings.height),
      .aovs = AovFilm(settings.width, settings.height, settings.aovs),
      .layers =
          LayerFilm(settings.width, settings.height, integrator.layers(), settings.wantsFeatures()),
      .features = FeatureFilm(settings.width, settings.height, settings.wantsFeatures())};
  Schedule schedule(settings);
  Renderer renderer(integrator, world, camera, settings, training, result);
  if (training) training->tracePhotons(1 + kRaysOfHit * renderer.fractionOfHits());

  uint32_t& done = result.samples;
  for (uint32_t wanted; (wanted = schedule.next(done, result.film)) > done; done = wanted) {
    if (schedule.endsPilot()) renderer.adapt(done);
    const auto report = [&](double fraction) {
      progress(schedule.progress(done + fraction * (wanted - done)));
    };
    renderer.pass(done, wanted, report, stop);
    if (stop) {
      result.interrupted = true;
      break;
    }
  }
  renderer.gather();
  if (training) {
    result.guidedRegions = training->lights().guidedRegions();
    result.causticFraction = training->caustics().empty() ? 0 : training->caustics().fraction();
  }
  return result;
}

RenderResult render(const World& world, const Camera& camera, const LightingStrategy& lighting,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop) {
  GuideTraining training(world, lighting, settings, GuideTraining::Guides::Both);
  return render(PathIntegrator(PathTracer(world, lighting, training.guided(settings.path()))),
                world, camera, settings, progress, stop, &training);
}

}  // namespace chromeball

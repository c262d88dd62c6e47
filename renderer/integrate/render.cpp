#include "integrate/render.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <mutex>

namespace chromeball {
namespace {

constexpr int kTile = 16;
constexpr uint32_t kLargestBlock = 4096;
// Deeper vertices carry too little for stratification to show; they take plain random numbers.
constexpr int kTabulatedVertices = 6;
constexpr uint32_t kLeastForNoise = 8;  // samples a pixel before an estimate of noise is believed

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

uint32_t powerOfTwoBelow(double x) {
  return std::bit_floor(uint32_t(std::clamp(x, 0.0, double(kLargestBlock))));
}

// Decides how many samples each pixel gets next; 0 ends the render.
class Schedule {
 public:
  explicit Schedule(const RenderSettings& settings) : settings_(settings), start_(now()) {
    if (!open()) plan_ = planBlocks(uint32_t(settings.samples));
  }

  uint32_t largest() const { return open() ? kLargestBlock : plan_.front(); }

  uint32_t next(uint32_t pass, uint32_t done, const Film& film) const {
    if (!open()) return pass < plan_.size() ? plan_[pass] : 0;
    const double left = double(settings_.samples) - done;
    if (done == 0) return 1;
    double wanted = std::min(left, double(done));
    if (settings_.timeLimit) {
      const double elapsed = now() - start_;
      wanted = std::min(wanted, (*settings_.timeLimit - elapsed) * done / elapsed);
    }
    if (settings_.noiseLimit && done >= kLeastForNoise) {
      const double ratio = film.noise() / *settings_.noiseLimit;
      if (ratio <= 1) return 0;
      wanted = std::min(wanted, std::ceil(done * (ratio * ratio - 1)));
    }
    return powerOfTwoBelow(wanted);
  }

  // Share of the work done after `samples`; NaN where only the noise tells.
  double progress(double samples) const {
    if (settings_.timeLimit) return std::min(1.0, (now() - start_) / *settings_.timeLimit);
    if (settings_.noiseLimit) return std::nan("");
    return samples / settings_.samples;
  }

 private:
  bool open() const { return settings_.timeLimit || settings_.noiseLimit; }

  const RenderSettings& settings_;
  double start_;
  std::vector<uint32_t> plan_;
};

struct Worker {
  PathMemory memory;
  InvalidSamples invalid;
};

class Renderer {
 public:
  Renderer(const Integrator& integrator, const Accel& accel, const Camera& camera,
           const RenderSettings& settings, uint32_t largestBlock, RenderResult& result)
      : integrator_(integrator),
        accel_(accel),
        camera_(camera, float(settings.width) / float(settings.height)),
        settings_(settings),
        result_(result),
        table_(std::bit_ceil(largestBlock),
               dimension::kVertex +
                   dimension::kPerVertex * std::min(settings.maxDepth + 1, kTabulatedVertices),
               settings.seed),
        workers_([this] {
          return Worker{{PixelSampler(table_, settings_.seed), {}, {}, Clamp(settings_.clamp)}, {}};
        }) {}

  // Adds one block to every pixel. `progress` is told the share of the pass.
  void pass(uint32_t block, uint32_t samples, const Progress& progress,
            const std::atomic<bool>& stop) {
    const int columns = (settings_.width + kTile - 1) / kTile;
    const int tiles = columns * ((settings_.height + kTile - 1) / kTile);
    std::atomic<int> finished = 0;
    std::mutex reporting;
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tiles, 1),
        [&](const tbb::blocked_range<int>& range) {
          Worker& worker = workers_.local();
          for (int tile = range.begin(); tile < range.end() && !stop; ++tile) {
            renderTile(worker, tile % columns * kTile, tile / columns * kTile, block, samples);
            const int count = ++finished;
            if (std::unique_lock lock(reporting, std::try_to_lock); lock)
              progress(double(count) / tiles);
          }
        },
        tbb::simple_partitioner());
  }

  void gather() {
    for (const Worker& worker : workers_) {
      result_.rays.add(worker.memory.rays);
      result_.invalid.add(worker.invalid);
      result_.clamped.add(worker.memory.clamp.clamped());
    }
  }

 private:
  void renderTile(Worker& worker, int left, int top, uint32_t block, uint32_t samples) {
    for (int y = top; y < std::min(top + kTile, settings_.height); ++y)
      for (int x = left; x < std::min(left + kTile, settings_.width); ++x)
        renderPixel(worker, x, y, block, samples);
  }

  // Makes the camera's rays of the samples from `begin` on, as many as fit, and follows them.
  Accel::Packet cameraHits(PixelSampler& sampler, int x, int y, uint32_t begin, uint32_t samples,
                           std::array<Ray, Accel::kPacket>& rays) const {
    std::array<uint32_t, Accel::kPacket> keys;
    const uint32_t count = std::min(samples - begin, uint32_t(Accel::kPacket));
    for (uint32_t lane = 0; lane < count; ++lane) {
      sampler.startSample(begin + lane);
      const vec2 offset = sampler.get2(dimension::kPixel);
      const float u = (float(x) + offset.x) / float(settings_.width);
      const float v = (float(y) + offset.y) / float(settings_.height);
      Ray& ray = rays[lane];
      if (camera_.hasLens())
        camera_.ray(u, v, sampler.get2(dimension::kLens), ray.origin, ray.direction);
      else
        camera_.ray(u, v, ray.origin, ray.direction);
      keys[lane] = sampler.sampleKey();
    }
    return accel_.intersect(std::span(rays).first(count), std::span(keys).first(count));
  }

  void renderPixel(Worker& worker, int x, int y, uint32_t block, uint32_t samples) {
    FirstHit first;
    FirstHit* wantsFirst = result_.aovs.empty() ? nullptr : &first;
    SampleSums sums;
    PixelSampler& sampler = worker.memory.sampler;
    sampler.startPixel(uint32_t(x), uint32_t(y), block);
    std::array<Ray, Accel::kPacket> rays;
    Accel::Packet hits;
    for (uint32_t i = 0; i < samples; ++i) {
      const uint32_t lane = i % Accel::kPacket;
      if (lane == 0) hits = cameraHits(sampler, x, y, i, samples, rays);
      sampler.startSample(i);
      first = {};
      const CameraSample sample{x, y, rays[lane], hits[lane]};
      const Rgb radiance = integrator_.radiance(sample, worker.memory, wantsFirst);
      if (const auto defect = defectOf(radiance, integrator_.isSigned())) {
        worker.invalid.add(*defect, x, y);
        result_.aovs.add(x, y, *defect);
      } else {
        sums.add(radiance);
      }
      if (wantsFirst) {
        first.depth = camera_.depth(sample.ray.direction, first.depth);
        result_.aovs.add(x, y, first);
      }
    }
    result_.film.addBlock(x, y, sums);
  }

  const Integrator& integrator_;
  const Accel& accel_;
  CameraRays camera_;
  const RenderSettings& settings_;
  RenderResult& result_;
  SobolTable table_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace

std::vector<uint32_t> planBlocks(uint32_t samples) {
  std::vector<uint32_t> blocks;
  const uint32_t largest = std::min(kLargestBlock, std::bit_floor(std::max(1u, samples / 2)));
  for (uint32_t left = samples; left > 0; left -= blocks.back())
    blocks.push_back(std::min(largest, std::bit_floor(left)));
  return blocks;
}

Beam beamOf(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
  if (scene.textures.empty()) return {};
  // Where the number of samples is open, textures are sharp enough for many and smooth for few.
  constexpr double kOpenSamples = 16;
  const bool open = settings.timeLimit || settings.noiseLimit;
  return beamOf(camera, settings.height, open ? kOpenSamples : settings.samples);
}

RenderResult render(const Scene& scene, const Accel& accel, const Camera& camera,
                    const LightingStrategy& lighting, const RenderSettings& settings,
                    const Progress& progress, const std::atomic<bool>& stop) {
  const std::unique_ptr<Emitters> emitters = Emitters::make(scene);
  const std::unique_ptr<PunctualLights> punctual = PunctualLights::make(scene);
  const Beam beam = beamOf(scene, camera, settings);
  const PathScene<Accel> path{scene,
                              accel,
                              lighting,
                              emitters.get(),
                              settings.mis,
                              settings.maxDepth,
                              settings.hideProbe,
                              punctual.get(),
                              beam};
  prepareBsdfs(scene);
  return render(PathIntegrator(path), accel, camera, settings, progress, stop);
}

RenderResult render(const Integrator& integrator, const Accel& accel, const Camera& camera,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop) {
  RenderResult result{Film(settings.width, settings.height),
                      AovFilm(settings.width, settings.height, settings.aovs),
                      {},
                      {},
                      {},
                      0,
                      false};
  const Schedule schedule(settings);
  Renderer renderer(integrator, accel, camera, settings, schedule.largest(), result);

  uint32_t done = 0;
  for (uint32_t pass = 0; uint32_t samples = schedule.next(pass, done, result.film); ++pass) {
    renderer.pass(
        pass, samples, [&](double share) { progress(schedule.progress(done + share * samples)); },
        stop);
    if (stop) {
      result.interrupted = true;
      break;
    }
    done += samples;
  }
  renderer.gather();
  result.samples = int(done);
  return result;
}

}  // namespace chromeball

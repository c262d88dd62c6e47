// SPDX-License-Identifier: Apache-2.0
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
constexpr uint32_t kLargestTable = 4096;  // samples of a half that share one randomisation
// Deeper vertices carry too little for stratification to show; they take plain random numbers.
constexpr int kTabulatedVertices = 6;
constexpr uint32_t kFirstPass = 4;        // samples a pixel
constexpr uint32_t kMinForNoise = 16;     // samples a pixel before an estimate of noise is believed
constexpr uint32_t kMaxInTheDark = 4096;  // samples a pixel without any light: there is none

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// How many of a pixel's first `samples` belong to a half.
uint32_t samplesOf(int half, uint32_t samples) {
  return samples / 2 + (half == 0 ? samples % 2 : 0);
}

// Decides how many samples a pixel has after each pass.
class Schedule {
 public:
  explicit Schedule(const RenderSettings& settings) : settings_(settings), start_(now()) {}

  // After the pass that follows `done` samples; at most `done` where the render ends.
  uint32_t next(uint32_t done, const Film& film) {
    if (done == 0) return std::min(kFirstPass, settings_.samples);
    double wanted = std::min(2.0 * done, double(settings_.samples));
    if (settings_.timeLimit) wanted = std::min(wanted, untilTime(done));
    if (settings_.noiseLimit && done >= kMinForNoise)
      wanted = std::min(wanted, untilNoise(done, film));
    return uint32_t(wanted);
  }

  // Share of the work done after `samples`; NaN where only the noise tells.
  double progress(double samples) const {
    if (settings_.timeLimit) return std::min(1.0, (now() - start_) / *settings_.timeLimit);
    if (settings_.noiseLimit) return std::nan("");
    return samples / settings_.samples;
  }

 private:
  // A pass has at least this share of the samples before it.
  static constexpr double kMinGrowth = 1.0 / 16;

  double untilTime(uint32_t done) const {
    const double affordable = done * *settings_.timeLimit / (now() - start_);
    return affordable < done * (1 + kMinGrowth) ? 0 : affordable;
  }

  // Noise falls as samples^-rate: 1/2 for independent samples, up to 1 for quasi-random ones.
  double untilNoise(uint32_t done, const Film& film) {
    const Noise noise = film.noise();
    if (std::isnan(noise.noise)) return done < kMaxInTheDark ? INFINITY : 0;
    const double excess = noise.upper / *settings_.noiseLimit;
    if (excess <= 1) return 0;
    double rate = 0.5;
    if (last_.samples > 0 && noise.noise < last_.noise)
      rate = std::log(last_.noise / noise.noise) / std::log(double(done) / last_.samples);
    last_ = {done, noise.noise};
    return done * std::max(std::pow(excess, 1 / std::clamp(rate, 0.5, 1.0)), 1 + kMinGrowth);
  }

  const RenderSettings& settings_;
  double start_;
  struct {
    uint32_t samples = 0;
    double noise = 0;
  } last_;  // estimate
};

struct Worker {
  PathMemory memory;
  InvalidSamples invalid;
};

class Renderer {
 public:
  Renderer(const Integrator& integrator, const Accel& accel, const Camera& camera,
           const RenderSettings& settings, RenderResult& result)
      : integrator_(integrator),
        accel_(accel),
        camera_(camera),
        cameraRays_(camera, float(settings.width) / float(settings.height)),
        settings_(settings),
        result_(result),
        table_(std::bit_ceil(std::min(samplesOf(0, settings.samples), kLargestTable)),
               dimension::kVertex + dimension::kPerVertex *
                                        (std::min(settings.maxDepth, kTabulatedVertices - 1) + 1),
               settings.seed),
        workers_([this] {
          return Worker{{PixelSampler(table_, settings_.seed), {}, {}, Clamp(settings_.clamp)}, {}};
        }) {}

  // Gives every pixel its samples [done, wanted). `progress` is told the share of the pass.
  void pass(uint32_t done, uint32_t wanted, const Progress& progress,
            const std::atomic<bool>& stop) {
    const Beam beam = beamOfPass(wanted);
    const int columns = (settings_.width + kTile - 1) / kTile;
    const int tiles = columns * ((settings_.height + kTile - 1) / kTile);
    std::atomic<int> finished = 0;
    std::mutex reporting;
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tiles, 1),
        [&](const tbb::blocked_range<int>& range) {
          Worker& worker = workers_.local();
          for (int tile = range.begin(); tile < range.end() && !stop; ++tile) {
            forPixels(tile % columns * kTile, tile / columns * kTile, [&](int x, int y) {
              for (int half = 0; half < Film::kHalves; ++half)
                renderHalf(worker, x, y, half, done, wanted, beam);
            });
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
  // Textures are filtered for the number of samples that a pixel will have; where that is open, has
  // had after the pass, so that they grow sharp with the samples.
  Beam beamOfPass(uint32_t wanted) const {
    if (accel_.scene().textures.empty()) return {};
    const bool open = settings_.timeLimit || settings_.noiseLimit;
    return beamOf(camera_, settings_.height, open ? wanted : settings_.samples);
  }

  template <class Visit>
  void forPixels(int left, int top, const Visit& visit) const {
    for (int y = top; y < std::min(top + kTile, settings_.height); ++y)
      for (int x = left; x < std::min(left + kTile, settings_.width); ++x) visit(x, y);
  }

  // Makes the camera's rays of the samples from `begin` on, as many as fit.
  Accel::Packet cameraHits(PixelSampler& sampler, int x, int y, uint32_t begin, uint32_t end,
                           std::array<Ray, Accel::kPacket>& rays) const {
    std::array<uint32_t, Accel::kPacket> keys;
    const uint32_t count = std::min(end - begin, uint32_t(Accel::kPacket));
    for (uint32_t lane = 0; lane < count; ++lane) {
      sampler.startSample(begin + lane);
      const vec2 offset = sampler.get2(dimension::kPixel);
      const float u = (float(x) + offset.x) / float(settings_.width);
      const float v = (float(y) + offset.y) / float(settings_.height);
      Ray& ray = rays[lane];
      if (cameraRays_.hasLens())
        cameraRays_.ray(u, v, sampler.get2(dimension::kLens), ray.origin, ray.direction);
      else
        cameraRays_.ray(u, v, ray.origin, ray.direction);
      keys[lane] = sampler.sampleKey();
    }
    return accel_.intersect(std::span(rays).first(count), std::span(keys).first(count));
  }

  // The samples of one half among the pixel's [done, wanted). A half that outgrows the table goes
  // on with it, newly randomised.
  void renderHalf(Worker& worker, int x, int y, int half, uint32_t done, uint32_t wanted,
                  const Beam& beam) {
    const uint32_t end = samplesOf(half, wanted);
    for (uint32_t begin = samplesOf(half, done); begin < end;) {
      const uint32_t table = begin / table_.size(), first = begin % table_.size();
      const uint32_t count = std::min(end - begin, table_.size() - first);
      worker.memory.sampler.startPixel(uint32_t(x), uint32_t(y),
                                       Film::kHalves * uint64_t(table) + uint64_t(half));
      result_.film.add(x, y, half, renderSamples(worker, x, y, first, first + count, beam));
      begin += count;
    }
  }

  // Samples [begin, end) of the sampler's table.
  SampleSums renderSamples(Worker& worker, int x, int y, uint32_t begin, uint32_t end,
                           const Beam& beam) {
    FirstHit first;
    FirstHit* wantsFirst = result_.aovs.empty() ? nullptr : &first;
    SampleSums sums;
    PixelSampler& sampler = worker.memory.sampler;
    std::array<Ray, Accel::kPacket> rays;
    Accel::Packet hits;
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t lane = (i - begin) % Accel::kPacket;
      if (lane == 0) hits = cameraHits(sampler, x, y, i, end, rays);
      sampler.startSample(i);
      first = {};
      const CameraSample camera{x, y, rays[lane], hits[lane], beam};
      const Sample sample = integrator_.sample(camera, worker.memory, wantsFirst);
      if (sample.defect) {
        worker.invalid.add(*sample.defect, x, y);
        result_.aovs.add(x, y, *sample.defect);
      } else {
        sums.add(sample.radiance);
      }
      if (wantsFirst) {
        first.depth = cameraRays_.depth(camera.ray.direction, first.depth);
        result_.aovs.add(x, y, first);
      }
    }
    return sums;
  }

  const Integrator& integrator_;
  const Accel& accel_;
  const Camera& camera_;
  CameraRays cameraRays_;
  const RenderSettings& settings_;
  RenderResult& result_;
  SobolTable table_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace

RenderResult render(const Scene& scene, const Accel& accel, const Camera& camera,
                    const LightingStrategy& lighting, const RenderSettings& settings,
                    const Progress& progress, const std::atomic<bool>& stop) {
  const std::unique_ptr<Emitters> emitters = Emitters::make(scene);
  const std::unique_ptr<PunctualLights> punctual = PunctualLights::make(scene);
  const PathScene<Accel> path{scene,
                              accel,
                              lighting,
                              emitters.get(),
                              settings.mis,
                              settings.maxDepth,
                              settings.hideProbe,
                              punctual.get(),
                              lighting.mirrorAlpha(),
                              settings.maxTransmissionDepth};
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
  Schedule schedule(settings);
  Renderer renderer(integrator, accel, camera, settings, result);

  uint32_t& done = result.samples;
  for (uint32_t wanted; (wanted = schedule.next(done, result.film)) > done; done = wanted) {
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
  return result;
}

}  // namespace chromeball

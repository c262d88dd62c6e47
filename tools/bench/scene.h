// SPDX-License-Identifier: Apache-2.0
// The scene of the rendering benchmarks: the still life, matte or metallic. CHROMEBALL_PROBE
// replaces the default probe, a studio.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>

#include "demo/gallery.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "scene/gltf/load_gltf.h"
#include "transport/camera_samples.h"
#include "transport/integrator.h"

namespace chromeball {

inline constexpr int kWidth = 320, kHeight = 240, kSamples = 64, kDepth = 5;

inline Image benchmarkProbe(const ImageSize& size = {1024, 512}) {
  const char* path = std::getenv("CHROMEBALL_PROBE");
  return path ? loadProbe(path).latLong : studioProbe(size);
}

struct BenchmarkScene {
  Scene scene;
  World world;
  Probe probe;
  std::unique_ptr<LightSource> lighting;

  explicit BenchmarkScene(Scene s)
      : scene(std::move(s)),
        world(scene),
        probe(benchmarkProbe()),
        lighting(makeStrategy("importance", probe, Mis::Balance, "benchmark")) {}

  PathTracer tracer() const { return {world, *lighting, {.maxDepth = kDepth}}; }

  static const BenchmarkScene& get(demo::Finish finish) {
    static const BenchmarkScene lambertian(load(demo::Finish::Lambertian));
    static const BenchmarkScene conductors(load(demo::Finish::Conductors));
    static const BenchmarkScene fine(load(demo::Finish::Fine));
    return finish == demo::Finish::Lambertian ? lambertian
           : finish == demo::Finish::Fine     ? fine
                                              : conductors;
  }

  static Scene load(demo::Finish finish) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "chromeball-benchmark.glb";
    demo::writeStillLife(file, finish);
    Scene scene = loadGltf(file, {}, [](const std::string&) {});
    std::filesystem::remove(file);
    return scene;
  }
};

// Calls radiance(rays, context) for the camera rays of every pixel, on this thread; `log` may be
// null.
template <class Radiance>
Rgb sumOverPixels(const Camera& camera, int samples, Radiance&& radiance, RayLog* log = nullptr) {
  const CameraRays rays(camera, float(kWidth) / kHeight);
  const SobolTable table(64, dimension::kVertex + dimension::kPerVertex * (kDepth + 1), 1);
  PathContext context{.sampler = PixelSampler(table, 1), .clamp = Clamp(), .log = log};
  PixelSampler& sampler = context.sampler;
  std::vector<Ray> ofPixel(static_cast<size_t>(samples));
  Rgb sum(0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      sampler.startPixel(uint32_t(x), uint32_t(y), 0);
      for (int i = 0; i < samples; ++i) {
        sampler.startSample(uint32_t(i));
        const vec2 offset = sampler.get2(dimension::kPixel);
        Ray& ray = ofPixel[size_t(i)];
        rays.ray((float(x) + offset.x) / kWidth, (float(y) + offset.y) / kHeight, ray.origin,
                 ray.direction);
      }
      sum += radiance(std::span<const Ray>(ofPixel), context);
    }
  return sum;
}

inline constexpr int kTraced = PathBatch::kMaxPaths;  // samples per pixel of the following

// Calls radiance(cameras, context) for the samples of every pixel, with their hits, on this thread;
// `log` may be null.
template <class Radiance>
Rgb sumOverSamples(const Camera& camera, const World& world, Radiance&& radiance,
                   RayLog* log = nullptr) {
  CameraPixel pixel;
  CameraSamples cameras;
  return sumOverPixels(
      camera, kTraced,
      [&](std::span<const Ray> rays, PathContext& context) {
        cameras.clear();
        pixel.numbers = context.sampler.pixel();
        for (size_t i = 0; i < rays.size(); ++i) {
          if (log) log->rays.push_back({rays[i], false});
          cameras.add(pixel, context.sampler, uint32_t(i), 0);
          cameras.setRay(i, rays[i]);
        }
        cameras.findHits(world, kAllInstances);
        return radiance(cameras, context);
      },
      log);
}

// Traces the paths of the whole image, as a render does.
inline Rgb traceImage(const BenchmarkScene& s, RayLog* log) {
  const PathTracer tracer = s.tracer();
  return sumOverSamples(
      s.scene.cameras.front(), s.world,
      [&](const CameraSamples& cameras, PathContext& context) {
        const std::span<const Rgb> radiances = PathBatch::traced(cameras, tracer, context);
        Rgb sum(0);
        for (size_t i = 0; i < cameras.size(); ++i) sum += radiances[i];
        return sum;
      },
      log);
}

// How the benchmarks are reported.
inline void inMilliseconds(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime();
}

// CPU time, of this thread unless the clock is another.
inline double cpuSeconds(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec t;
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace chromeball

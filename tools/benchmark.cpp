// What a render costs beside its rays: samples and rays a second, and the time of the same rays
// replayed by Embree alone. CHROMEBALL_PROBE names another probe than the project's own studio.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "demo/still_life.h"
#include "integrate/path.h"
#include "integrate/render.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "scene/gltf.h"
#include "trace/accel.h"

BENCHMARK_MAIN();

namespace chromeball {
namespace {

constexpr int kWidth = 320, kHeight = 240, kSamples = 64, kDepth = 5;

Image benchmarkProbe() {
  if (const char* path = std::getenv("CHROMEBALL_PROBE")) return loadProbe(path).latLong;
  return studioProbe({1024, 512});
}

struct Setting {
  Scene scene;
  Accel accel;
  Probe probe;
  std::unique_ptr<LightingStrategy> lighting;
  std::unique_ptr<Emitters> emitters;

  explicit Setting(Scene s)
      : scene(std::move(s)),
        accel(scene),
        probe(benchmarkProbe()),
        lighting(makeStrategy("importance", probe, Mis::Balance, "benchmark")),
        emitters(Emitters::make(scene)) {
    prepareBsdfs(scene);
  }

  static const Setting& get(demo::Finish finish) {
    static const Setting lambertian(load(demo::Finish::Lambertian));
    static const Setting conductors(load(demo::Finish::Conductors));
    return finish == demo::Finish::Lambertian ? lambertian : conductors;
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

// Answers as Accel does, and remembers what it was asked.
struct Recorder {
  struct Query {
    Ray ray;
    bool shadow;
  };
  const Accel& accel;
  mutable std::vector<Query> queries;

  bool intersect(const Ray& ray, uint32_t key, Hit& hit) const {
    queries.push_back({ray, false});
    return accel.intersect(ray, key, hit);
  }
  float transmittance(const Ray& ray) const {
    queries.push_back({ray, true});
    return accel.transmittance(ray);
  }
};

// One thread's paths over the picture, `samples` a pixel.
template <class Rays>
Rgb tracePicture(const Setting& s, const Rays& rays, int samples) {
  const PathScene<Rays> path{s.scene, rays, *s.lighting, s.emitters.get(), Mis::Balance, kDepth};
  const CameraRays camera(s.scene.cameras.front(), float(kWidth) / kHeight);
  const SobolTable table(64, dimension::kVertex + dimension::kPerVertex * 6, 1);
  PixelSampler sampler(table, 1);
  std::vector<DirectionSample> scratch;
  RayCounts counts;
  Rgb sum(0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      sampler.startPixel(uint32_t(x), uint32_t(y), 0);
      for (int i = 0; i < samples; ++i) {
        sampler.startSample(uint32_t(i));
        const vec2 offset = sampler.get2(dimension::kPixel);
        Ray ray;
        camera.ray((float(x) + offset.x) / kWidth, (float(y) + offset.y) / kHeight, ray.origin,
                   ray.direction);
        sum += pathRadiance(path, ray, sampler, scratch, counts, nullptr);
      }
    }
  return sum;
}

void render(benchmark::State& state, demo::Finish finish) {
  const Setting& s = Setting::get(finish);
  RenderSettings settings;
  settings.width = kWidth, settings.height = kHeight, settings.samples = kSamples;
  settings.maxDepth = kDepth;
  const std::atomic<bool> stop = false;
  double samples = 0, rays = 0;
  for (auto _ : state) {
    const RenderResult r = chromeball::render(s.scene, s.accel, s.scene.cameras.front(),
                                              *s.lighting, settings, [](double) {}, stop);
    samples += double(r.rays.camera);
    rays += double(r.rays.camera + r.rays.shadow + r.rays.bounce);
    settings.seed++;
  }
  using benchmark::Counter;
  state.counters["samples/s"] = Counter(samples, Counter::kIsRate);
  state.counters["rays/s"] = Counter(rays, Counter::kIsRate);
  state.counters["rays/sample"] = rays / samples;
}

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Render time over the time of the same rays alone, both of one thread and in turn.
void overhead(benchmark::State& state, demo::Finish finish) {
  constexpr int kTraced = 16;
  const Setting& s = Setting::get(finish);
  const Recorder recorder{s.accel, {}};
  benchmark::DoNotOptimize(tracePicture(s, recorder, kTraced));
  double whole = 0, alone = 0;
  for (auto _ : state) {
    const double start = cpuSeconds();
    benchmark::DoNotOptimize(tracePicture(s, s.accel, kTraced));
    const double middle = cpuSeconds();
    for (const Recorder::Query& query : recorder.queries) {
      Hit hit;
      if (query.shadow)
        benchmark::DoNotOptimize(s.accel.transmittance(query.ray));
      else
        benchmark::DoNotOptimize(s.accel.intersect(query.ray, 0, hit));
    }
    const double end = cpuSeconds();
    whole += middle - start;
    alone += end - middle;
  }
  const double samples = double(state.iterations()) * kWidth * kHeight * kTraced;
  state.counters["ratio"] = whole / alone;
  state.counters["ns/sample"] = 1e9 * whole / samples;
  state.counters["ns/sample in Embree"] = 1e9 * alone / samples;
}

BENCHMARK_CAPTURE(render, lambertian, demo::Finish::Lambertian)
    ->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(render, conductors, demo::Finish::Conductors)
    ->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(overhead, lambertian, demo::Finish::Lambertian)
    ->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(overhead, conductors, demo::Finish::Conductors)
    ->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The error of a composite with an inaccurate local scene: the terrace with composited objects,
// against a reference image of terrace and objects together; for the difference formula and for the
// ratio. The error is computed over pixels that see the local scene and that the objects change by
// more than 2%. The objects are made rough, because the noise of caustics of the sun would hide
// these errors.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "composite/compose.h"
#include "composite/local_scene.h"
#include "composite/reflectance.h"
#include "composite/render_composite.h"
#include "demo/gallery.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {
namespace {

constexpr int kColumns = 120, kRows = 80, kReferenceSamples = 4096, kCompositeSamples = 1024;
constexpr float kRough = 0.7f;
const std::atomic<bool> kGoOn = false;
const auto kQuiet = [](double) {};

Scene load(demo::Terrace what, float minRoughness = kRough) {
  const auto file = std::filesystem::temp_directory_path() / "chromeball-terrace.glb";
  demo::writeTerrace(file, what);
  Scene scene = loadGltf(file, {}, [](const std::string&) {});
  std::filesystem::remove(file);
  for (Material& m : scene.materials) m.roughness = std::max(m.roughness, minRoughness);
  return scene;
}

RenderSettings settingsOf(int samples, uint64_t seed) {
  RenderSettings s;
  s.width = kColumns, s.height = kRows, s.samples = samples, s.seed = seed;
  s.hideProbe = true;
  return s;
}

Image renderTerrace(demo::Terrace what, const Probe& probe, uint64_t seed) {
  const Scene scene = load(what);
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "benchmark");
  return render(World(scene), scene.cameras.front(), *lighting, settingsOf(kReferenceSamples, seed),
                kQuiet, kGoOn)
      .film.mean();
}

struct ReferenceImages {
  Image probe = demo::terraceProbe(512);
  Image plate = renderTerrace(demo::Terrace::Photograph, Probe(probe), 1);
  Image whole = renderTerrace(demo::Terrace::Whole, Probe(probe), 2);

  static const ReferenceImages& get() {
    static const ReferenceImages images;
    return images;
  }
};

// Whether the objects change the pixel by more than 2%.
bool isChanged(int x, int y) {
  const double plate = luminance(ReferenceImages::get().plate.rgb(x, y));
  return std::abs(luminance(ReferenceImages::get().whole.rgb(x, y)) - plate) > 0.02 * plate;
}

enum class Reflectance { True, Grey, Solved };
struct Mistake {
  Reflectance reflectance = Reflectance::True;
  float albedo = 1;    // factor on the local scene's
  float exposure = 1;  // factor on the probe
  int maxDepth = 8;
};

void errorOf(const Image& found, const DifferentialFilm& film, const char* name,
             benchmark::State& state) {
  const ReferenceImages& reference = ReferenceImages::get();
  double squares = 0, sum = 0, wholeSum = 0;
  int count = 0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      if (film.at(x, y).covered > 0 || !isChanged(x, y)) continue;
      const double whole = luminance(reference.whole.rgb(x, y));
      const double error = luminance(found.rgb(x, y)) - whole;
      squares += error * error / (whole * whole + 0.01);
      sum += error, wholeSum += whole, ++count;
    }
  state.counters[std::string(name) + " rel. RMSE %"] = 100 * std::sqrt(squares / count);
  state.counters[std::string(name) + " bias %"] = 100 * sum / wholeSum;
}

ObjectMask objectsOf(const Scene& scene) {
  return findObjects(scene, {{"floor", ""}, {"wall", ""}, {"pillar", ""}, {"vase", ""}}, "");
}

void compositeError(benchmark::State& state, const Mistake& mistake) {
  const ReferenceImages& reference = ReferenceImages::get();
  const bool isTrue = mistake.reflectance == Reflectance::True;
  Scene scene = load(isTrue ? demo::Terrace::Whole : demo::Terrace::Model);
  const ObjectMask isObject = objectsOf(scene);
  for (size_t i = 0; i < isObject.size(); ++i)
    if (!isObject[i]) {
      vec4& color = scene.materials[size_t(scene.instances[i].material)].baseColor;
      color = vec4(Rgb(color) * mistake.albedo, color.w);
    }
  const Probe probe(reference.probe, 0, Rgb(mistake.exposure));
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "benchmark");
  const Camera& camera = scene.cameras.front();
  RenderSettings settings = settingsOf(kCompositeSamples, 3);
  settings.maxDepth = mistake.maxDepth;

  Projection projection(camera, kColumns, kRows);
  if (mistake.reflectance == Reflectance::Solved) makeProjected(scene, isObject, projection);
  const World world(scene, rayMasks(isObject));
  for (auto _ : state) {
    if (mistake.reflectance == Reflectance::Solved)
      solveReflectance({world, camera, *lighting, reference.plate}, settings, 2, projection, kQuiet,
                       kGoOn);
    const CompositeRender r = renderComposite(world, camera, *lighting, reference.plate, settings,
                                              Passes::One, false, kQuiet, kGoOn);
    for (CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio})
      errorOf(compose(r.film(), r.mean, reference.plate, mode).color, r.film(),
              mode == CompositeMode::Difference ? "difference" : "ratio", state);
  }
}

#define MISTAKE(name, ...)                                     \
  BENCHMARK_CAPTURE(compositeError, name, Mistake __VA_ARGS__) \
      ->Iterations(1)                                          \
      ->Unit(benchmark::kMillisecond)
MISTAKE(none, {});
MISTAKE(reflectance solved from the plate, {.reflectance = Reflectance::Solved});
MISTAKE(grey 0.3 everywhere, {.reflectance = Reflectance::Grey});
MISTAKE(reflectance - 30 %, {.albedo = 0.7f});
MISTAKE(reflectance - 10 %, {.albedo = 0.9f});
MISTAKE(reflectance + 10 %, {.albedo = 1.1f});
MISTAKE(reflectance + 30 %, {.albedo = 1.3f});
MISTAKE(probe - 30 %, {.exposure = 0.7f});
MISTAKE(probe - 10 %, {.exposure = 0.9f});
MISTAKE(probe + 10 %, {.exposure = 1.1f});
MISTAKE(probe + 30 %, {.exposure = 1.3f});
MISTAKE(probe - 30 % and solved, {.reflectance = Reflectance::Solved, .exposure = 0.7f});
MISTAKE(no interreflection, {.maxDepth = 1});
#undef MISTAKE

// The variance of the difference from two renders over that from one pass: in all pixels that see
// the local scene, and in those that the objects change. (In an umbra nothing cancels, so one pass
// has no advantage there.)
void compositeNoise(benchmark::State& state, float minRoughness) {
  const ReferenceImages& reference = ReferenceImages::get();
  const Scene scene = load(demo::Terrace::Whole, minRoughness);
  const World world(scene, rayMasks(objectsOf(scene)));
  const Probe probe(reference.probe);
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "benchmark");
  const auto renderIn = [&](Passes passes) {
    return renderComposite(world, scene.cameras.front(), *lighting, reference.plate,
                           settingsOf(kCompositeSamples, 3), passes, false, kQuiet, kGoOn);
  };
  for (auto _ : state) {
    const CompositeRender one = renderIn(Passes::One), two = renderIn(Passes::Two);
    const auto oneErrors = squaredStandardErrors(one.errors);
    const auto twoErrors = squaredStandardErrors(two.errors);
    glm::dvec2 all(0), changed(0);  // sums of squared standard errors
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        if (one.film().at(x, y).covered > 0) continue;
        const size_t i = size_t(y) * kColumns + size_t(x);
        const glm::dvec2 errors(oneErrors[i].w, twoErrors[i].w);
        all += errors;
        if (isChanged(x, y)) changed += errors;
      }
    state.counters["gain"] = all.y / all.x;
    state.counters["gain where changed"] = changed.y / changed.x;
  }
}
BENCHMARK_CAPTURE(compositeNoise, rough objects, kRough)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compositeNoise, mirrors and gold, 0.0f)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chromeball

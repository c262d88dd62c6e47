// SPDX-License-Identifier: Apache-2.0
// Paths that are traced together find the same as one at a time.
#include "transport/integrator.h"

#include <gtest/gtest.h>

#include "lighting/probe_light.h"
#include "paths.h"
#include "probe/synth.h"
#include "render/pixel_renderer.h"
#include "scene/gltf/load_gltf.h"
#include "small_scenes.h"
#include "transport/camera_samples.h"
#include "transport/trace_photons.h"

#include <fmt/format.h>

namespace chromeball::path_batch_test {
namespace {

class OneAtATime : public SingleIntegrator {
 public:
  explicit OneAtATime(const PathTracer& tracer) : tracer_(tracer) {}

 private:
  Sample sample(const CameraSample& camera, PathContext& context) const override {
    return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  }

  PathTracer tracer_;
};

// Paths in lanes round differently. `amplification`: of rounding errors, by curved mirrors.
void expectSame(const NamedScene& named, const Camera& camera, const LightSource& lighting,
                const RenderSettings& settings, const LightGuide* guide = nullptr,
                const CausticGuide* caustics = nullptr, float amplification = 1) {
  const World world(named.scene, {}, allTables());
  PathSettings path = settings.path();
  path.guide = guide;
  path.caustics = caustics;
  const PathTracer tracer(world, lighting, path);
  const std::atomic<bool> stop = false;
  const auto rendered = [&](const Integrator& integrator) {
    return render(
        integrator, world, camera, settings, [](double) {}, stop);
  };
  const RenderResult together = rendered(PathIntegrator(tracer));
  const RenderResult single = rendered(OneAtATime(tracer));

  // Packets may find another triangle for a ray through an edge, or at a silhouette.
  const double fraction = 1e-4 * double(std::sqrt(amplification));
  const auto close = [&](uint64_t a, uint64_t b) {
    return std::fabs(double(a) - double(b)) <= fraction * double(b);
  };
  EXPECT_EQ(together.rays.camera, single.rays.camera);
  EXPECT_PRED2(close, together.rays.shadow, single.rays.shadow);
  EXPECT_PRED2(close, together.rays.bounce, single.rays.bounce);
  EXPECT_EQ(together.invalid.total(), single.invalid.total());
  EXPECT_NEAR(together.depthCut.fraction(DepthLimit::Depth),
              single.depthCut.fraction(DepthLimit::Depth), 1e-5);
  const Image a = together.film.mean(), b = single.film.mean();
  int differing = 0;
  for (int y = 0; y < b.height; ++y)
    for (int x = 0; x < b.width; ++x)
      differing += maxComponent(absolute(a.rgb(x, y) - b.rgb(x, y))) >
                   1e-5f * amplification * (1e-3f + maxComponent(b.rgb(x, y)));
  // Among guided bounces the last bits of a pdf may turn a choice of the roulette, too.
  EXPECT_LE(differing, b.width * b.height / (caustics ? 200 : 500));
}

void expectSame(const NamedScene& named, const Camera& camera, const std::string& strategy,
                const RenderSettings& settings, const LightGuide* guide = nullptr,
                const CausticGuide* caustics = nullptr, float amplification = 1) {
  SCOPED_TRACE(std::string(named.name) + ", " + strategy);
  const Probe probe(named.probe);
  const auto lighting = makeStrategy(strategy, probe, settings.mis, "test");
  expectSame(named, camera, *lighting, settings, guide, caustics, amplification);
}

Camera cameraAbove() {
  return Camera::lookAt({0, 1.6f, 3}, {0, 0.5f, 0}, {0, 1, 0}, glm::radians(50.0f));
}

TEST(PathBatch, FindsWhatSinglePathsFind) {
  // 37 samples in two halves: batches of 16, 3 and 2.
  RenderSettings settings = smallRender(40, 30, 37, 5);
  for (const NamedScene& named : threeScenes())
    for (const char* strategy : {"importance", "suns", "median-cut:8", "bsdf"})
      expectSame(named, cameraAbove(), strategy, settings);
}

// Light from one side, which the strategy seldom samples.
LightGuide someGuide() {
  std::vector<LightRecord> records;
  for (uint64_t i = 0; i < 20'000; ++i) {
    const auto number = [&](uint64_t purpose) { return toUnit(uint32_t(hash(i, purpose))); };
    const vec3 normal = squareToUniformSphere({number(1), number(2)});
    const vec3 direction = glm::normalize(vec3(1 + number(3), number(4), number(5)));
    const vec3 position(4 * number(6) - 2, 2 * number(7), 4 * number(8) - 2);
    records.push_back({position, normal, direction, 1, 1, 1e-3f, 0.1f});
  }
  LightGuide guide;
  guide.learn(std::move(records));
  return guide;
}

// `uniform` with its samples taken for many vertices at once.
class UniformAtMany : public Uniform {
 public:
  using Uniform::Uniform;
  size_t batch() const override { return 100; }
  void sampleAt(std::span<const LightPoint> points, std::span<const glm::uvec2> numbers,
                std::span<DirectionSample> out) const override {
    EXPECT_LE(points.size(), batch());
    largest = std::max<size_t>(largest, points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const vec2 u(toUnit(numbers[i].x), toUnit(numbers[i].y));
      const vec3 wi = Frame(points[i].normal).toWorld(squareToUniformHemisphere(u));
      out[i] = {wi, probe_.radiance(wi) * (2 * kPi), 0.5f * kInvPi};
    }
  }
  void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const override {
    EXPECT_LE(rays.size(), batch());
    Uniform::escapedMany(rays, out);
  }
  mutable std::atomic<size_t> largest = 0;
};

TEST(PathBatch, SamplesOfManyVerticesAreThoseOfEach) {
  const LightGuide guide = someGuide();
  for (const NamedScene& named : threeScenes()) {
    SCOPED_TRACE(named.name);
    const Probe probe(named.probe);
    const UniformAtMany lighting(probe);
    for (const LightGuide* g : {static_cast<const LightGuide*>(nullptr), &guide})
      expectSame(named, cameraAbove(), lighting, smallRender(40, 30, 37, 5), g);
    EXPECT_GT(lighting.largest, PathBatch::kMaxPaths);
  }
}

TEST(PathBatch, AlsoAdaptivelyAndWithDeepPaths) {
  RenderSettings settings = smallRender(40, 30, 64, 60);
  settings.adaptive = true;
  settings.aovs = {Aov::Albedo, Aov::Depth};
  for (const NamedScene& named : threeScenes())
    expectSame(named, cameraAbove(), "importance", settings);
}

TEST(SlowPathBatch, AlsoAmongMirrorsAndALantern) {
  NamedScene named{"still life",
                   loadGltf(std::string(kSourceDir) + "/scenes/models/still-life.glb", {},
                            [](const std::string&) {}),
                   studioProbe({64, 32})};
  ASSERT_FALSE(named.scene.cameras.empty());
  const Camera camera = named.scene.cameras.front();
  constexpr float kOfBalls = 100;
  expectSame(named, camera, "importance", smallRender(60, 45, 32, 8), nullptr, nullptr, kOfBalls);
}

TEST(PathBatch, AlsoWithAGuide) {
  const LightGuide guide = someGuide();
  ASSERT_GT(guide.guidedRegions(), 6u);
  for (const NamedScene& named : threeScenes()) {
    const RenderSettings settings = smallRender(40, 30, 37, 5);
    expectSame(named, cameraAbove(), "importance", settings, &guide);
  }
}

TEST(PathBatch, AlsoWithGuidedBounces) {
  for (const NamedScene& named : {threeScenes()[1], threeScenes()[2]}) {
    const World world(named.scene, {}, allTables());
    const Probe probe(named.probe);
    const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
    const CausticGuide caustics(tracePhotons(world, *lighting, {20'000}, 1));
    ASSERT_FALSE(caustics.empty());
    constexpr float kOfLobes = 10;  // whose pdfs change much with a direction's last bits
    expectSame(named, cameraAbove(), "importance", smallRender(40, 30, 37, 5), nullptr, &caustics,
               kOfLobes);
  }
}

template <class Traced>
RenderResult renderedBy(const NamedScene& named, int depth) {
  const World world(named.scene, {}, allTables());
  const Probe probe(named.probe);
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const RenderSettings settings = smallRender(40, 30, 37, depth);
  const std::atomic<bool> stop = false;
  return render(
      Traced(PathTracer(world, *lighting, settings.path())), world, cameraAbove(), settings,
      [](double) {}, stop);
}

// Without a bounce left, rays are only asked whether they escape, unless a surface might show then:
// the material that is added, though nothing has it.
TEST(PathBatch, LastRaysFindWhatClosestHitsFind) {
  for (const NamedScene& named : threeScenes())
    for (const int depth : {1, 3}) {
      SCOPED_TRACE(std::string(named.name) + ", depth " + std::to_string(depth));
      const RenderResult together = renderedBy<PathIntegrator>(named, depth),
                         single = renderedBy<OneAtATime>(named, depth);
      NamedScene full = named;
      full.scene.materials.emplace_back().emission = Rgb(1);
      const RenderResult fullTogether = renderedBy<PathIntegrator>(full, depth);
      EXPECT_EQ(together.film.mean().texels, fullTogether.film.mean().texels);
      EXPECT_EQ(together.depthCut.fraction(DepthLimit::Depth),
                fullTogether.depthCut.fraction(DepthLimit::Depth));
      EXPECT_EQ(single.film.mean().texels, renderedBy<OneAtATime>(full, depth).film.mean().texels);
    }
}

// Lamps of all kinds, more than are sampled at later vertices; a lamp on a ceiling, whose place it
// shares, and one that is seen through glass and in a mirror.
NamedScene litScene() {
  NamedScene named{"lamps of all kinds", {}, constantProbe({16, 8}, Rgb(0.05f))};
  Scene& s = named.scene;
  const int floor = addMaterial(s, lambert({0.7f, 0.6f, 0.5f}));
  addQuad(s, floor, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addQuad(s, floor, {-1, 2, 1}, {0, 0, -2}, {2, 0, 0});
  Material lamp = lambert(Rgb(0.3f));
  lamp.emission = {3, 2, 1};
  lamp.doubleSided = false;
  const int panel = addMaterial(s, lamp);
  addQuad(s, panel, {-0.4f, 2, 0.4f}, {0, 0, -0.8f}, {0.8f, 0, 0});
  lamp.roughness = 0.3f, lamp.specular = 1;
  addSphere(s, addMaterial(s, lamp), {0.9f, 0.4f, 0.4f}, 0.3f, 12);
  Material glass, mirror;
  glass.metallic = glass.roughness = mirror.roughness = 0;
  glass.extended.emplace().transmission = 1;
  glass.extended->thinWalled = false;
  addSphere(s, addMaterial(s, glass), {0, 0.5f, 1}, 0.35f, 16);
  addSphere(s, addMaterial(s, mirror), {-0.9f, 0.5f, 0}, 0.5f, 16);
  for (int i = 0; i < 20; ++i)
    s.lights.push_back({.kind = PunctualLight::Kind::Point,
                        .intensity = Rgb(0.05f + 0.01f * float(i)),
                        .position = {0.3f * float(i) - 3, 1.5f, -1}});
  s.lights.push_back({.kind = PunctualLight::Kind::Spot,
                      .intensity = Rgb(2),
                      .position = {0, 1.9f, 1},
                      .direction = {0, -1, 0}});
  s.lights.push_back({.kind = PunctualLight::Kind::Directional,
                      .intensity = {0.2f, 0.3f, 0.4f},
                      .direction = glm::normalize(vec3(1, -2, -1))});
  return named;
}

TEST(PathBatch, UnderTheScenesOwnLights) {
  const NamedScene named = litScene();
  for (const Mis mis : {Mis::Balance, Mis::Power, Mis::Off})
    for (const int depth : {1, 2, 6}) {
      RenderSettings settings = smallRender(40, 30, 37, depth);
      settings.mis = mis;
      SCOPED_TRACE(fmt::format("{} {}", int(mis), depth));
      expectSame(named, cameraAbove(), "importance", settings);
    }
  RenderSettings layers = smallRender(40, 30, 16, 4);
  layers.aovs = {Aov::Albedo, Aov::Depth, Aov::Normal};
  layers.denoise = true;
  expectSame(named, cameraAbove(), "importance", layers);
  NamedScene dark = named;
  dark.probe = constantProbe({8, 4}, Rgb(0));
  expectSame(dark, cameraAbove(), "importance", smallRender(40, 30, 37, 4));
}

// What guides learn from paths of 16 pixels that are traced together, and from the same paths
// alone.
struct RecordsOfBoth {
  GuideRecords together, single;
};

RecordsOfBoth recordsOf(const World& world, const PathTracer& tracer) {
  RecordsOfBoth records;
  const SobolTable table(64, dimension::tabulated(5), 0);
  for (uint32_t at = 0; at < 16; ++at) {
    CameraPixel pixel;
    CameraSamples cameras;
    PathContext context{.sampler = PixelSampler(table, 0), .clamp = Clamp()};
    context.sampler.set(pixel.numbers, at, 0, 0);
    for (uint32_t i = 0; i < 64; ++i) {
      cameras.add(pixel, context.sampler, i, 0);
      const vec3 origin(0, 1.6f, 3), target(0.03f * float(i) - 1, 0.3f, 0.1f * float(at));
      cameras.setRay(i, {origin, glm::normalize(target - origin)});
    }
    cameras.findHits(world, kAllInstances);
    context.records = &records.together;
    PathBatch::traced(cameras, tracer, context);
    context.records = &records.single;
    for (size_t i = 0; i < cameras.size(); ++i) {
      const CameraSample camera = cameras[i];
      camera.start(context.sampler);
      tracer.radiance(camera.path(), camera.hit, context);
    }
  }
  return records;
}

TEST(PathBatch, GuidesLearnTheSameUnderTheScenesOwnLights) {
  const NamedScene named = litScene();
  const World world(named.scene, {}, allTables());
  const Probe probe(named.probe);
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const PathTracer tracer(world, *lighting, smallRender(4, 4, 16, 4).path());
  const RecordsOfBoth records = recordsOf(world, tracer);
  ASSERT_GT(records.single.lights.size(), 800u);
  EXPECT_EQ(records.together.lights.size(), records.single.lights.size());
  const auto sum = [](const GuideRecords& of) {
    double total = 0;
    for (const LightRecord& light : of.lights) total += light.integrand / light.density;
    return total;
  };
  EXPECT_NEAR(sum(records.together) / sum(records.single), 1, 1e-4);
}

TEST(PathBatch, GuidesLearnTheSameFromGuidedBounces) {
  for (const NamedScene& named : {threeScenes()[1], threeScenes()[2], litScene()}) {
    SCOPED_TRACE(named.name);
    const World world(named.scene, {}, allTables());
    const Probe probe(named.probe);
    const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
    const CausticGuide caustics(tracePhotons(world, *lighting, {20'000}, 1));
    ASSERT_FALSE(caustics.empty());
    PathSettings settings = smallRender(4, 4, 16, 6).path();
    settings.caustics = &caustics;
    const PathTracer tracer(world, *lighting, settings);
    const auto [together, single] = recordsOf(world, tracer);
    ASSERT_GT(single.bounces.size(), 100u);
    EXPECT_NEAR(double(together.bounces.size()) / double(single.bounces.size()), 1, 2e-3);
    const auto sums = [](const GuideRecords& records) {
      glm::dvec3 sum(0);
      for (const BounceRecord& r : records.bounces)
        sum += glm::dvec3(r.found, double(r.lobesPdf) / double(r.bsdfPdf + r.lobesPdf), r.fraction);
      return sum;
    };
    const glm::dvec3 a = sums(together), b = sums(single);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i] / b[i], 1, 5e-3) << i;
  }
}

// A floor of tilted shading normals, which its reflection has to lift, under a lamp at which only
// the lifted ones look.
TEST(PathBatch, LampsLightWhatLiftedNormalsSee) {
  NamedScene named{"tilted normals", {}, constantProbe({8, 4}, Rgb(0))};
  Scene& s = named.scene;
  Material rough;
  rough.roughness = 0.5f;
  for (const float metallic : {0.0f, 1.0f}) {
    rough.metallic = metallic;
    addQuad(s, addMaterial(s, rough), {metallic - 1, 0, 1}, {1, 0, 0}, {0, 0, -2});
    s.meshes.edit(s.meshes.size() - 1).normals.assign(4, glm::normalize(vec3(2.7f, 1, 0)));
  }
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(50);
  addSphere(s, addMaterial(s, lamp), {-2, 2.5f, 0}, 0.3f, 12);
  s.lights.push_back(
      {.kind = PunctualLight::Kind::Point, .intensity = Rgb(4), .position = {-2, 2, 1}});
  for (const Mis mis : {Mis::Balance, Mis::Off}) {
    RenderSettings settings = smallRender(40, 30, 37, 2);
    settings.mis = mis;
    expectSame(named, cameraAbove(), "importance", settings);
  }
}

// A thread may come to a tile that needs no samples before any other.
TEST(PathBatch, OfNoPaths) {
  const NamedScene named = threeScenes()[0];
  const World world(named.scene, {}, allTables());
  const Probe probe(named.probe);
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  const RenderSettings settings = smallRender(4, 3, 8, 2);
  const PathIntegrator integrator(PathTracer(world, *lighting, settings.path()));
  RenderResult result(settings, {});
  const PixelRenderer pixels(integrator, world, cameraAbove(), settings, result);
  PixelWorker worker = pixels.makeWorker();
  pixels.render(worker, 1, 1, 8, 8, {}, 0);
  pixels.finish(worker);
  EXPECT_EQ(worker.context.counts.camera, 0u);
}

// A black probe has no light samples.
TEST(PathBatch, UnderABlackProbe) {
  std::vector<NamedScene> scenes = threeScenes();
  scenes[2].probe = constantProbe({8, 4}, Rgb(0));
  expectSame(scenes[2], cameraAbove(), "importance", smallRender(40, 30, 16, 4));
}

}  // namespace
}  // namespace chromeball::path_batch_test

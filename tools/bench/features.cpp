// SPDX-License-Identifier: Apache-2.0
// The cost of unused features in a matte scene: the renderer against a path tracer that supports
// only Lambertian materials and the strategy `importance`, and no textures, instances, alpha or
// lamps. Both use the same random numbers, so both compute the same image.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <utility>

#include "lighting/importance.h"
#include "math/vec.h"
#include "math/warp.h"
#include "scene.h"
#include "transport/path_settings.h"

namespace chromeball {
namespace {

struct LeanScene {
  const Scene& scene;
  const Accel& accel;
  const Importance& importance;
  const Probe& probe;
};

struct LeanPoint {
  vec3 position, geometricNormal, normal;
  float offset;

  vec3 origin(const vec3& wi) const {
    return position + (glm::dot(geometricNormal, wi) < 0 ? -offset : offset) * geometricNormal;
  }
};

LeanPoint leanPointAt(const Mesh& mesh, const Hit& hit, const vec3& wo) {
  const Triangle t = mesh.triangles[hit.triangle];
  const vec3 p0 = mesh.positions[t.x], p1 = mesh.positions[t.y], p2 = mesh.positions[t.z];
  const float b1 = hit.barycentric.x, b2 = hit.barycentric.y, b0 = 1 - b1 - b2;
  LeanPoint s;
  s.position = b0 * p0 + b1 * p1 + b2 * p2;
  const vec3 front = glm::normalize(glm::cross(p1 - p0, p2 - p0));
  s.geometricNormal = glm::dot(front, wo) >= 0 ? front : -front;
  const vec3 extent = glm::max(glm::abs(p0), glm::max(glm::abs(p1), glm::abs(p2)));
  s.offset = 0x1p-19f * glm::dot(glm::abs(front) + 1.0f / 1024, extent);
  s.normal = s.geometricNormal;
  if (!mesh.normals.empty()) {
    vec3 n =
        glm::normalize(b0 * mesh.normals[t.x] + b1 * mesh.normals[t.y] + b2 * mesh.normals[t.z]);
    if (glm::dot(front, wo) < 0) n = -n;
    if (glm::dot(n, s.geometricNormal) > 0) s.normal = n;
  }
  return s;
}

// Several paths, a vertex of each at a time, as in PathBatch.
class LeanBatch {
 public:
  explicit LeanBatch(const LeanScene& scene) : scene_(scene) {}

  Rgb trace(std::span<const Ray> rays, PixelSampler& sampler) {
    sum_ = Rgb(0);
    count_ = rays.size();
    for (size_t i = 0; i < count_; ++i) paths_[i] = {uint32_t(i), rays[i], Rgb(1), 0};
    for (depth_ = 0; count_ > 0; ++depth_) {
      findHits();
      endEscaped();
      if (depth_ == kDepth) break;
      drawLightSamples(sampler);
      size_t remaining = 0;
      shadows_ = 0;
      for (size_t i = 0; i < count_; ++i)
        if (shade(i, sampler)) paths_[remaining++] = paths_[i];
      traceShadowRays();
      count_ = remaining;
    }
    return sum_;
  }

 private:
  struct Path {
    uint32_t sample;
    Ray ray;
    Rgb throughput;
    float pdf;
  };

  void findHits() {
    for (size_t i = 0; i < count_; ++i) rays_[i] = paths_[i].ray;
    const auto coherence = depth_ == 0 ? Accel::Coherence::High : Accel::Coherence::None;
    scene_.accel.intersect(std::span(rays_).first(count_), std::span(keys_).first(count_),
                           coherence, std::span(hits_).first(count_));
  }

  void endEscaped() {
    size_t escapes = 0, remaining = 0;
    for (size_t i = 0; i < count_; ++i) {
      if (hits_[i]) {
        hits_[remaining] = hits_[i];
        std::swap(paths_[remaining++], paths_[i]);
      } else if (depth_ == 0) {
        sum_ += scene_.probe.radiance(paths_[i].ray.direction);
      } else {
        escaped_[escapes] = paths_[i];
        escapes_[escapes++] = {&nowhere_, paths_[i].ray.direction};
      }
    }
    scene_.importance.escapedMany(std::span(escapes_).first(escapes), found_);
    for (size_t k = 0; k < escapes; ++k)
      sum_ += escaped_[k].throughput * found_[k].radiance *
              bsdfSampleWeight(Mis::Balance, escaped_[k].pdf, found_[k].pdf);
    count_ = remaining;
  }

  const Instance& instance(size_t i) const { return scene_.scene.instances[hits_[i]->instance]; }

  void drawLightSamples(PixelSampler& sampler) {
    for (size_t i = 0; i < count_; ++i) {
      prefetchTriangle(scene_.scene, instance(i), hits_[i]->triangle);
      start(i, sampler);
      numbers_[i] = {sampler.bits(dimension::kLight), sampler.bits(dimension::kLight + 1)};
    }
    scene_.importance.sampleMany(std::span(numbers_).first(count_),
                                 std::span(lights_).first(count_));
    for (size_t i = 0; i < count_; ++i)
      prefetchVertices(scene_.scene, instance(i), hits_[i]->triangle);
  }

  bool shade(size_t i, PixelSampler& sampler) {
    start(i, sampler);
    Path& path = paths_[i];
    const Mesh& mesh = scene_.scene.meshes[size_t(instance(i).mesh)];
    const LeanPoint s = leanPointAt(mesh, *hits_[i], -path.ray.direction);
    const Rgb albedo(scene_.scene.materials[size_t(instance(i).material)].baseColor);
    const DirectionSample& light = lights_[i];
    const float cosine = glm::dot(s.normal, light.wi) * kInvPi;
    if (light.pdf > 0 && cosine > 0 && glm::dot(s.geometricNormal, light.wi) > 0) {
      rays_[shadows_] = {s.origin(light.wi), light.wi};
      lit_[shadows_++] = path.throughput * albedo * light.irradiance *
                         (cosine * misWeight(Mis::Balance, light.pdf, cosine));
    }
    const vec3 wi =
        Frame(s.normal).toWorld(squareToCosineHemisphere(sampler.get2(dimension::kBsdf)));
    path.pdf = glm::dot(s.normal, wi) * kInvPi;
    if (!(path.pdf > 0) || !(glm::dot(s.geometricNormal, wi) > 0)) return false;
    path.throughput *= albedo;
    path.ray = {s.origin(wi), wi};
    return survivesRoulette(path.throughput, 1, depth_, sampler);
  }

  void traceShadowRays() {
    scene_.accel.transmittance(std::span(rays_).first(shadows_),
                               std::span(transmittances_).first(shadows_));
    for (size_t k = 0; k < shadows_; ++k) sum_ += lit_[k] * transmittances_[k];
  }

  void start(size_t i, PixelSampler& sampler) const {
    sampler.startSample(paths_[i].sample);
    sampler.startVertex(depth_);
  }

  static constexpr size_t kMax = LightSource::kMaxMany;
  const LeanScene& scene_;
  const LightPoint nowhere_{};
  Rgb sum_{0};
  int depth_ = 0;
  size_t count_ = 0, shadows_ = 0;
  std::array<Path, kMax> paths_, escaped_;
  std::array<Ray, kMax> rays_;
  std::array<uint32_t, kMax> keys_{};
  std::array<std::optional<Hit>, kMax> hits_;
  std::array<LightSource::Escape, kMax> escapes_;
  std::array<LightSource::Escaped, kMax> found_;
  std::array<glm::uvec2, kMax> numbers_;
  std::array<DirectionSample, kMax> lights_;
  std::array<Rgb, kMax> lit_, transmittances_;
};

void unusedFeatures(benchmark::State& state) {
  const BenchmarkScene& s = BenchmarkScene::get(demo::Finish::Lambertian);
  const Importance importance(s.probe, true);
  const LeanScene scene{s.scene, s.world.accel, importance, s.probe};
  const Camera& camera = s.scene.cameras.front();
  const auto lean = std::make_unique<LeanBatch>(scene);
  double fullSeconds = 0, leanSeconds = 0;
  Rgb fullSum(0), leanSum(0);
  for (auto _ : state) {
    const double start = cpuSeconds();
    fullSum = traceImage(s, nullptr);
    const double middle = cpuSeconds();
    leanSum = sumOverPixels(camera, kTraced, [&](std::span<const Ray> rays, PathContext& context) {
      return lean->trace(rays, context.sampler);
    });
    fullSeconds += middle - start;
    leanSeconds += cpuSeconds() - middle;
  }
  if (std::fabs(luminance(fullSum) / luminance(leanSum) - 1) > 1e-3)
    state.SkipWithError("the two images differ");
  state.counters["cost of unused features"] = fullSeconds / leanSeconds - 1;
}
BENCHMARK(unusedFeatures)->Apply(inMilliseconds)->MinTime(4);

}  // namespace
}  // namespace chromeball

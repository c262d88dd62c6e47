// SPDX-License-Identifier: Apache-2.0
// The cost of unused features in a matte scene: the renderer against a path tracer that supports
// only Lambertian materials and the strategy `importance`, and no textures, instances, alpha or
// lamps. Both use the same random numbers, so both compute the same image.
#include <benchmark/benchmark.h>

#include "integrate/mis.h"
#include "lighting/importance.h"
#include "math/frame.h"
#include "math/warp.h"
#include "scene.h"

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

Rgb leanRadiance(const LeanScene& lean, Ray ray, PixelSampler& sampler) {
  Rgb radiance(0), throughput(1);
  float pdf = 0;
  for (int depth = 0;; ++depth) {
    sampler.startVertex(depth);
    Hit hit;
    if (!lean.accel.intersect(ray, 0, hit)) {
      if (depth == 0) return lean.probe.radiance(ray.direction);
      const auto escaped = lean.importance.escaped({}, ray.direction);
      return radiance +
             throughput * escaped.radiance * bsdfSampleWeight(Mis::Balance, pdf, escaped.pdf);
    }
    if (depth == kDepth) return radiance;

    const Instance& instance = lean.scene.instances[hit.instance];
    const LeanPoint s = leanPointAt(lean.scene.meshes[instance.mesh], hit, -ray.direction);
    const Rgb albedo(lean.scene.materials[instance.material].baseColor);
    const DirectionSample light = lean.importance.sampleDirection(
        sampler.bits(dimension::kLight) * 0x1p-32, sampler.bits(dimension::kLight + 1) * 0x1p-32);
    const float cosine = glm::dot(s.normal, light.wi) * kInvPi;
    if (light.pdf > 0 && cosine > 0 && glm::dot(s.geometricNormal, light.wi) > 0 &&
        !isBlack(lean.accel.transmittance({s.origin(light.wi), light.wi})))
      radiance += throughput * albedo * light.irradiance *
                  (cosine * misWeight(Mis::Balance, light.pdf, cosine));

    const vec3 wi =
        Frame(s.normal).toWorld(squareToCosineHemisphere(sampler.get2(dimension::kBsdf)));
    pdf = glm::dot(s.normal, wi) * kInvPi;
    if (!(pdf > 0) || !(glm::dot(s.geometricNormal, wi) > 0)) return radiance;
    throughput *= albedo;
    if (!survivesRoulette(throughput, depth, sampler)) return radiance;
    ray = {s.origin(wi), wi};
  }
}

void unusedFeatures(benchmark::State& state) {
  constexpr int kTraced = 16;
  const BenchmarkScene& s = BenchmarkScene::get(demo::Finish::Lambertian);
  const Importance importance(s.probe, true);
  const LeanScene lean{s.scene, s.world.accel, importance, s.probe};
  const PathTracer full = s.tracer();
  const Camera& camera = s.scene.cameras.front();
  double fullSeconds = 0, leanSeconds = 0;
  Rgb fullSum(0), leanSum(0);
  for (auto _ : state) {
    const double start = cpuSeconds();
    fullSum = sumOverImage(camera, kTraced, [&](const Ray& ray, PathContext& context) {
      return full.radiance(PathState{ray}, full.closestHit(ray, context), context);
    });
    const double middle = cpuSeconds();
    leanSum = sumOverImage(camera, kTraced, [&](const Ray& ray, PathContext& context) {
      return leanRadiance(lean, ray, context.sampler);
    });
    fullSeconds += middle - start;
    leanSeconds += cpuSeconds() - middle;
  }
  if (std::fabs(luminance(fullSum) / luminance(leanSum) - 1) > 1e-3)
    state.SkipWithError("the two images differ");
  state.counters["cost of unused features"] = fullSeconds / leanSeconds - 1;
}
BENCHMARK(unusedFeatures)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(4);

}  // namespace
}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "integrate/guiding/photon.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "integrate/media.h"
#include "math/frame.h"
#include "math/warp.h"
#include "shading/bsdf.h"

namespace chromeball {
namespace {

constexpr size_t kPathsPerTask = 4096;
constexpr int kMaxBounces = 12;
constexpr float kMaxRoughness = 0.5f;  // of a material that may have narrow lobes

bool mayHaveNarrowLobes(const Material& m) {
  return m.roughness <= kMaxRoughness || m.metallicRoughnessTexture || m.extended;
}

struct Sphere {
  vec3 center{0};
  float radius = 0;
};

Sphere sphereAround(const Scene& scene, const Instance& instance) {
  const std::vector<vec3>& positions = scene.meshes[size_t(instance.mesh)].positions;
  Bounds box;
  for (const vec3& p : positions) {
    box.min = glm::min(box.min, instance.point(p));
    box.max = glm::max(box.max, instance.point(p));
  }
  Sphere sphere{box.min + (box.max - box.min) / 2.0f, 0};
  for (const vec3& p : positions)
    sphere.radius = std::max(sphere.radius, glm::distance(instance.point(p), sphere.center));
  return sphere;
}

// An instance that paths start towards. The probability is proportional to the radius, so that
// small objects are not forgotten beside a polished floor.
struct Target {
  uint32_t instance;
  Sphere sphere;
  double probability, upTo;  // the sum of the probabilities up to this one
};

std::vector<Target> targetsOf(const Scene& scene) {
  std::vector<Target> targets;
  double sum = 0;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!mayHaveNarrowLobes(scene.materials[size_t(instance.material)])) continue;
    const Sphere sphere = sphereAround(scene, instance);
    if (!(sphere.radius > 0 && std::isfinite(sphere.radius))) continue;
    sum += sphere.radius;
    targets.push_back({i, sphere, sphere.radius, sum});
  }
  for (Target& t : targets) t.probability /= sum, t.upTo /= sum;
  return targets;
}

// The random numbers of one path.
class Random {
 public:
  explicit Random(uint64_t key) : key_(key) {}
  uint32_t bits() { return uint32_t(hash(key_, ++index_)); }
  float get1() { return toUnit(bits()); }
  vec2 get2() {
    const float x = get1();
    return {x, get1()};
  }

 private:
  uint64_t key_, index_ = 0;
};

class PhotonTracer {
 public:
  PhotonTracer(const World& world, const LightingStrategy& lighting)
      : world_(world), lighting_(lighting), targets_(targetsOf(world.scene)) {
    const Bounds box = bounds(world.scene);
    sceneSize_ = glm::distance(box.min, box.max);
  }

  bool hasTargets() const { return !targets_.empty(); }

  void trace(uint64_t key, std::vector<Photon>& out) const {
    Random random(key);
    const Target& target = chooseTarget(random);
    const uint32_t first = random.bits(), second = random.bits();
    const glm::uvec2 bits(first, second);
    DirectionSample light{};
    lighting_.sampleMany(std::span(&bits, 1), std::span(&light, 1));
    if (!(light.pdf > 0)) return;
    follow(startTowards(target, light.wi, random.get2()), target,
           luminance(light.irradiance) * kPi * target.sphere.radius * target.sphere.radius /
               float(target.probability),
           light.wi, random, out);
  }

 private:
  const Target& chooseTarget(Random& random) const {
    const double u = double(random.bits()) * 0x1p-32;
    const auto found =
        std::upper_bound(targets_.begin(), targets_.end(), u,
                         [](double x, const Target& target) { return x < target.upTo; });
    return found == targets_.end() ? targets_.back() : *found;
  }

  // A ray of the beam that covers the target's sphere, from outside the scene.
  Ray startTowards(const Target& target, const vec3& light, vec2 u) const {
    const float r = target.sphere.radius * std::sqrt(u.x);
    const Frame frame(light);
    return {target.sphere.center + frame.toWorld(r * unitVector(0, u.y)) +
                (sceneSize_ + target.sphere.radius) * light,
            -light};
  }

  Bsdf bsdfAt(const Surface& surface, const Instance& instance, const vec3& wo,
              const Media& media) const {
    const MaterialPoint material = materialAt(world_.scene, surface);
    if (!surface.material->extended)
      return Bsdf(material, surface, wo, world_.bsdfTables, lighting_.mirrorAlpha());
    return Bsdf(material, extendedMaterialAt(world_.scene, instance, surface),
                media.refractiveIndex(surface, Rgb(1)), surface, wo, world_.bsdfTables,
                lighting_.mirrorAlpha());
  }

  // Until the path leaves the scene or a bounce is not narrow.
  void follow(Ray ray, const Target& target, float flux, const vec3& emission, Random& random,
              std::vector<Photon>& out) const {
    Media media;
    uint64_t chain = 0;
    for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
      Hit hit;
      if (!world_.accel.intersect(ray, random.bits(), hit)) return;
      if (bounce == 0 && hit.instance != target.instance) return;  // counted with that one
      const Instance& instance = world_.scene.instances[hit.instance];
      const Surface surface =
          surfaceAt(world_.scene, instance, hit.triangle, hit.barycentric, -ray.direction);
      flux *= luminance(media.transmittance(hit.distance));
      const Bsdf bsdf = bsdfAt(surface, instance, -ray.direction, media);
      BsdfSample next;
      const vec2 u = random.get2();
      if (!bsdf.sample(u, random.get1(), next)) return;
      if (!next.isDelta && next.pdf < kConcentratedPdf) {
        if (bounce > 0 && flux > 0 && std::isfinite(flux))
          out.push_back(
              {surface.position, bsdf.normal(), -ray.direction, emission, uint32_t(chain), flux});
        return;
      }
      chain = hash(chain, hit.instance);
      flux *= luminance(next.weight);
      media.follow(surface, next.wi);
      ray = {surface.rayOrigin(next.wi), next.wi};
    }
  }

  const World& world_;
  const LightingStrategy& lighting_;
  std::vector<Target> targets_;
  float sceneSize_;
};

}  // namespace

std::vector<Photon> tracePhotons(const World& world, const LightingStrategy& lighting, size_t count,
                                 uint64_t seed) {
  const PhotonTracer tracer(world, lighting);
  if (!tracer.hasTargets() || !lighting.sampleMany({}, {})) return {};
  std::vector<std::vector<Photon>> found((count + kPathsPerTask - 1) / kPathsPerTask);
  tbb::parallel_for(size_t(0), found.size(), [&](size_t task) {
    const size_t end = std::min(count, (task + 1) * kPathsPerTask);
    for (size_t i = task * kPathsPerTask; i < end; ++i)
      tracer.trace(hash(seed, i, 0x70686f746f6e), found[task]);
  });
  std::vector<Photon> photons;
  for (const auto& some : found) photons.insert(photons.end(), some.begin(), some.end());
  return photons;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "transport/trace_photons.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/parallel.h"
#include "math/vec.h"
#include "math/warp.h"
#include "scene/bounds.h"
#include "shading/bsdf.h"
#include "trace/accel.h"
#include "transport/media.h"

namespace chromeball {
namespace {

constexpr size_t kPathsPerTask = 4096;
constexpr int kMaxBounces = 12;
constexpr float kMaxRoughness = 0.5f;  // of a material that may have narrow lobes

bool mayHaveNarrowLobes(const Material& m) {
  if (m.straightShadows) return false;  // light passes it without a change of direction
  return m.roughness <= kMaxRoughness || m.hasRoughnessTexture() ||
         (m.extended && (m.extended->transmission > 0 || m.extended->clearcoat > 0));
}

struct Sphere {
  vec3 center{0};
  float radius = 0;
};

// Spheres around the instances, from the corners of their meshes' boxes.
std::vector<Sphere> spheresAround(const Scene& scene) {
  std::vector<Bounds> boxes;
  for (const Mesh& mesh : scene.meshes) boxes.push_back(bounds(mesh.positions));
  std::vector<Sphere> spheres;
  for (const Instance& instance : scene.instances) {
    const Bounds& box = boxes[size_t(instance.mesh)];
    const vec3 center = instance.point(box.min + (box.max - box.min) / 2.0f);
    Sphere sphere{center, 0};
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                   corner & 4 ? box.max.z : box.min.z);
      sphere.radius = std::max(sphere.radius, glm::distance(instance.point(p), center));
    }
    spheres.push_back(sphere);
  }
  return spheres;
}

// An instance that paths start towards. The probability is proportional to the radius, so that
// small objects are not forgotten beside a polished floor.
struct Target {
  uint32_t instance;
  Sphere sphere;
  double probability, upTo;  // the sum of the probabilities up to this one
};

std::vector<Target> targetsOf(const Scene& scene, const std::vector<Sphere>& spheres) {
  std::vector<Target> targets;
  double sum = 0;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!mayHaveNarrowLobes(scene.materials[size_t(instance.material)])) continue;
    const Sphere& sphere = spheres[i];
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

// The photons that a task has found, and its number of rays.
struct Traced {
  std::vector<Photon> photons;
  size_t rays = 0;
};

class PhotonTracer {
 public:
  PhotonTracer(const World& world, const LightSource& lighting)
      : world_(world), lighting_(lighting) {
    const std::vector<Sphere> spheres = spheresAround(world.scene);
    targets_ = targetsOf(world.scene, spheres);
    Bounds box;
    for (const Sphere& s : spheres) box.add(Bounds{s.center - s.radius, s.center + s.radius});
    sceneSize_ = glm::distance(box.min, box.max);
  }

  bool hasTargets() const { return !targets_.empty(); }

  void traceFromProbe(Random random, Traced& out) const {
    const Target& target = chooseTarget(random);
    const uint32_t first = random.bits(), second = random.bits();
    DirectionSample light{};
    if (!lighting_.sampleDistant({first, second}, light) || !(light.pdf > 0)) return;
    const float flux = luminance(light.irradiance) * kPi * target.sphere.radius *
                       target.sphere.radius / float(target.probability);
    follow({startTowards(target, light.wi, random.get2()), flux, light.wi, 0}, &target, random,
           out);
  }

  // Traces a path from a point on an emissive triangle, in a cosine-distributed direction.
  void traceFromLamp(Random random, Traced& out) const {
    const Emitters::Point lamp =
        world_.sources.emitters->choose(double(random.bits()) * 0x1p-32, random.get1());
    const Instance& instance = world_.scene.instances[lamp.instance];
    const auto surfaceTowards = [&](const vec3& direction) {
      return surfaceAt(world_.scene, instance, lamp.triangle, lamp.barycentric, direction);
    };
    const Surface some = surfaceTowards({0, 0, 1});
    const vec3 front = some.frontFace ? some.geometricNormal : -some.geometricNormal;
    const float sides = some.material->doubleSided ? 2 : 1;
    const vec3 normal = random.get1() < 1 / sides ? front : -front;
    const vec3 direction = Frame(normal).toWorld(squareToCosineHemisphere(random.get2()));
    const Surface surface = surfaceTowards(direction);
    const float flux = luminance(emittedRadiance(world_.scene, instance, surface, direction)) *
                       sides * kPi *
                       surfaceAlpha(world_.scene, instance, lamp.triangle, lamp.barycentric) /
                       world_.sources.emitters->pdf(lamp.instance, lamp.triangle, 1, 1);
    if (!(flux > 0)) {  // a black texel of an emissive texture
      ++out.rays;       // so that the budget ends
      return;
    }
    follow({rayFrom(surface, direction), flux, {0, 0, 1}, hash(lamp.instance)}, nullptr, random,
           out);
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

  struct Start {
    Ray ray;
    float flux;
    vec3 emission;
    uint64_t chain;
  };
  // Follows the path until it leaves the scene or a bounce is not narrow. `target`: null for lamps.
  void follow(const Start& start, const Target* target, Random& random, Traced& out) const {
    auto [ray, flux, emission, chain] = start;
    Media media;
    for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
      Hit hit;
      ++out.rays;
      if (!world_.accel.intersect(ray, random.bits(), hit)) return;
      if (world_.scene.materials[size_t(world_.scene.instances[hit.instance].material)]
              .straightShadows)
        return;
      if (bounce == 0 && target && hit.instance != target->instance)
        return;  // counted with that one
      const Instance& instance = world_.scene.instances[hit.instance];
      const Surface surface =
          surfaceAt(world_.scene, instance, hit.triangle, hit.barycentric, -ray.direction);
      flux *= luminance(media.transmittance(hit.distance));
      if (media.ignores(*surface.material, surface.frontFace)) {
        ray = rayFrom(surface, ray.direction);
        continue;
      }
      const Bsdf bsdf = bsdfAt(surface, instance, -ray.direction, media);
      BsdfSample next;
      const vec2 u = random.get2();
      if (!bsdf.sample(u, random.get1(), next)) return;
      if (!next.isDelta && next.pdf < kConcentratedPdf) {
        if (bounce > 0 && flux > 0 && std::isfinite(flux))
          out.photons.push_back(
              {surface.position, bsdf.normal(), -ray.direction, emission, uint32_t(chain), flux});
        return;
      }
      chain = hash(chain, hit.instance);
      flux *= luminance(next.weight);
      media.follow(surface, next.wi);
      ray = rayFrom(surface, next.wi);
    }
  }

  const World& world_;
  const LightSource& lighting_;
  std::vector<Target> targets_;
  float sceneSize_;
};

}  // namespace

std::vector<Photon> tracePhotons(const World& world, const LightSource& lighting,
                                 const PhotonBudget& budget, uint64_t seed) {
  const Scene& scene = world.scene;
  if (std::ranges::none_of(scene.materials, mayHaveNarrowLobes)) return {};  // before any bounds
  const PhotonTracer tracer(world, lighting);
  DirectionSample any{};
  const bool fromProbe = lighting.sampleDistant({0, 0}, any);
  const bool fromLamps = world.sources.emitters != nullptr;
  std::vector<Photon> photons;
  if (!tracer.hasTargets() || !(fromProbe || fromLamps)) return photons;
  const size_t tasks = (budget.paths + kPathsPerTask - 1) / kPathsPerTask;
  size_t rays = 0;
  for (size_t begin = 0, end = std::min<size_t>(tasks, 1); begin < end;) {
    std::vector<Traced> found(end - begin);
    parallelFor(begin, end, [&](size_t task) {
      const size_t last = std::min(budget.paths, (task + 1) * kPathsPerTask);
      for (size_t i = task * kPathsPerTask; i < last; ++i) {
        Traced& out = found[task - begin];
        if (fromProbe) tracer.traceFromProbe(Random(hash(seed, i, 0x70726f6265)), out);
        if (fromLamps) tracer.traceFromLamp(Random(hash(seed, i, 0x6c616d70)), out);
      }
    });
    for (const Traced& some : found) {
      photons.insert(photons.end(), some.photons.begin(), some.photons.end());
      rays += some.rays;
    }
    if (photons.empty()) break;
    // Traces twice as many paths as so far, within the budget.
    const double affordable = double(end) * std::max(budget.rays / double(rays) - 1, 0.0);
    begin = end;
    end = std::min({tasks, 3 * end, end + size_t(std::min(affordable, 1e9))});
  }
  return photons;
}

}  // namespace chromeball

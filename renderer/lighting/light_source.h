// SPDX-License-Identifier: Apache-2.0
// The interface of light sources: the light of a probe, sampled in any way, and all other light of
// a scene.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/sampler.h"
#include "math/vec.h"

namespace chromeball {

class Bsdf;
struct Instance;
struct LightArrays;
struct RayArrays;
struct Surface;

// A point that receives light.
struct LightPoint {
  vec3 position;
  vec3 normal;             // shading normal, on the viewer's side
  const Bsdf* bsdf;        // null in escaped(), and of plain surfaces (transport/plain_surfaces.h)
  int depth;               // 0 at the first hit; a strategy may take fewer samples at later hits
  bool transmits = false;  // light from behind contributes too
  float time = 0;          // of the shutter (scene/motion.h)
};

// The surface at which a shadow ray to a light in the scene ends.
struct LightEnd {
  static constexpr uint32_t kNone = ~0u;

  uint32_t instance = kNone, triangle = 0;  // as in Hit
  vec2 barycentric{0};
  vec3 position{0};  // offset from the surface, as origins of rays
};

// One direction for a shadow ray, as a directional light. `pdf` is the sum of the pdfs, over solid
// angle, of all samples of the call; `irradiance`, on a surface perpendicular to the direction, is
// radiance / pdf. So for any number of samples the estimate is the sum over samples of
//   f cos * irradiance.
struct DirectionSample {
  vec3 wi;  // unit, from the point to the light
  Rgb irradiance;
  float pdf;                  // unless isDelta
  bool isDelta = false;       // no BSDF sample can find the light: its MIS weight is 1
  int group = 0;              // of a delta light: index into LightSource::groups()
  float distance = INFINITY;  // metres
  LightEnd end{};
};

// Light of a probe, as a strategy samples it, or of a scene's other sources (scene_sources.h):
// lamps and emitting surfaces, which override less, and suns.
class LightSource {
 public:
  virtual ~LightSource() = default;

  // Appends zero or more samples.
  virtual void sample(const LightPoint& point, const PixelSampler& sampler,
                      std::vector<DirectionSample>& out) const = 0;

  // Radiance along a BSDF-sampled ray that left `point` in direction `wi` and hit nothing, and the
  // pdf of sample() for that direction, over solid angle; 0 if sample() cannot return it.
  struct Escaped {
    Rgb radiance;
    float pdf;

    Escaped& operator+=(const Escaped& other) {
      radiance += other.radiance, pdf += other.pdf;
      return *this;
    }
  };
  virtual Escaped escaped(const LightPoint&, const vec3&) const { return {Rgb(0), 0}; }

  // The pdf of sample(), over solid angle, for the point of a surface in the scene that a
  // BSDF-sampled ray from `point` hits; `instance` and `triangle` as in Hit. Its radiance is
  // emittedRadiance() (scene/surface.h) without texture filtering, as sample() has it.
  virtual float pdfOfHit(const LightPoint&, const Surface&, uint32_t /*instance*/,
                         uint32_t /*triangle*/) const {
    return 0;
  }

  // Whether a triangle of an emissive material is known to be black, texture filters apart: saves
  // looking its emission up.
  virtual bool knowsAsBlack(uint32_t /*instance*/, uint32_t /*triangle*/) const { return false; }

  // escaped() for up to kMaxMany rays, or batch(). Strategies override it where table reads of
  // several rays can overlap.
  static constexpr size_t kMaxMany = 64;
  struct Escape {
    const LightPoint* point;
    vec3 wi;
  };
  virtual void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const {
    for (size_t i = 0; i < rays.size(); ++i) out[i] = escaped(*rays[i].point, rays[i].wi);
  }

  // sample() for up to kMaxMany paths, from the bits of dimension::kLight and kLight + 1 of each; a
  // pdf of 0 stands for no sample. Returns false for strategies that take several samples or whose
  // samples depend on the point.
  virtual bool sampleMany(std::span<const glm::uvec2>, std::span<DirectionSample>) const {
    return false;
  }

  // sample() for up to batch() vertices of paths that are traced together, from the same bits: for
  // sources whose calls cost much, and whose samples may depend on the point. Sources that do so
  // return batch() above 0, and take one sample at most, which is not a delta. A pdf of 0 stands
  // for no sample. escapedMany() is then called for as many rays.
  virtual size_t batch() const { return 0; }
  virtual void sampleAt(std::span<const LightPoint>, std::span<const glm::uvec2>,
                        std::span<DirectionSample>) const {}

  // Whether sample() takes one sample at most, which is not a delta: the shadow rays of several
  // paths then form packets.
  virtual bool takesOneSample() const { return batch() > 0 || sampleMany({}, {}); }

  // Whether a guide may choose a direction in place of the samples that are no deltas
  // (render/guide_training.h).
  virtual bool canBeGuided() const { return sampleMany({}, {}); }

  // One direction that light comes from, drawn from two numbers, whatever the point: for paths that
  // start at the light. Its pdf is 0 if there is none. Returns false if there are no such paths.
  virtual bool sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const {
    return sampleMany(std::span(&numbers, 1), std::span(&out, 1));
  }

  // Radiance seen by the camera and by mirrors at `origin`, which sample() does not estimate.
  virtual Rgb background(const vec3&, const vec3&) const { return Rgb(0); }

  // background() for up to kMaxMany rays, or batch().
  struct Sight {
    vec3 origin, wi;
  };
  virtual void backgroundMany(std::span<const Sight> rays, std::span<Rgb> out) const {
    for (size_t i = 0; i < rays.size(); ++i) out[i] = background(rays[i].origin, rays[i].wi);
  }

  // sampleMany(), escapedMany() and backgroundMany() from and to arrays (lighting/light_arrays.h),
  // for sources for which sampleMany() returns true, and whose escapedMany() does not depend on the
  // point.
  virtual void sampleArrays(std::span<const uint32_t> u, const uint32_t* v, LightArrays& out) const;
  virtual void escapedArrays(const RayArrays& rays, size_t count, LightArrays& out) const;
  virtual void backgroundArrays(const RayArrays& rays, size_t count, LightArrays& out) const;

  // Specular lobes with a GGX alpha below this are treated as mirrors: they see background(), and
  // sample() does not light them. The scene's own lamps light them like all other lobes.
  virtual float mirrorAlpha() const { return 0; }

  // False for an approximation, whose error does not converge to 0 with the number of samples.
  virtual bool unbiased() const { return true; }

  // The names of the parts of the light that light groups tell apart (transport/light_groups.h).
  // Surfaces in the scene have none: they belong to their nodes' groups.
  virtual std::vector<std::string> groups() const { return {"probe"}; }
  // Splits the radiance of escaped(), or of background(), by group and adds it: one element of
  // `radiances` per group. Where a group holds what the camera and mirrors see, it is the last.
  virtual void splitEscaped(const LightPoint& point, const vec3& wi,
                            std::span<Rgb> radiances) const {
    radiances.front() += escaped(point, wi).radiance;
  }
  virtual void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const {
    radiances.back() += background(origin, wi);
  }
};

// A source that is another one but for what the camera and mirrors see, and for what classes
// override.
class WrappedLight : public LightSource {
 public:
  explicit WrappedLight(std::unique_ptr<LightSource> strategy) : strategy_(std::move(strategy)) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    strategy_->sample(point, sampler, out);
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return strategy_->escaped(point, wi);
  }
  bool takesOneSample() const override { return strategy_->takesOneSample(); }
  bool canBeGuided() const override { return strategy_->canBeGuided(); }
  float mirrorAlpha() const override { return strategy_->mirrorAlpha(); }
  bool unbiased() const override { return strategy_->unbiased(); }
  std::vector<std::string> groups() const override { return strategy_->groups(); }
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override {
    strategy_->splitEscaped(point, wi, radiances);
  }

 protected:
  std::unique_ptr<LightSource> strategy_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The light sources that a scene has besides its probe.
#pragma once

#include <memory>
#include <vector>

#include "lighting/emitters.h"
#include "lighting/light_source.h"
#include "lighting/suns.h"
#include "scene/scene.h"

namespace chromeball {

struct SceneSources {
  // Makes one source for each kind that occurs in the scene, which must outlive this.
  explicit SceneSources(const Scene& scene);

  std::vector<std::unique_ptr<const LightSource>> all;
  std::vector<size_t> distant;         // indices of those that rays find if they hit nothing
  const Emitters* emitters = nullptr;  // among `all`: photons start there; null if nothing emits
};

// The light that arrives at `position` (KHR_lights_punctual): intensity / distance^2, times
// max(min(1 - (distance / range)^4, 1), 0) for the range, and for a spot times ((cos - cosOuter) /
// (cosInner - cosOuter))^2, clamped to [0, 1] before squaring. A delta light. `time`: within the
// shutter interval.
DirectionSample incidentLight(const PunctualLight& light, const vec3& position, float time = 0);

// A scene's point, spot and directional lights (KHR_lights_punctual).
class PunctualLights : public LightSource {
 public:
  // Null if the scene has none. The scene must outlive this.
  static std::unique_ptr<PunctualLights> make(const Scene& scene);

  // The maximum number of samples at the first hit and at later hits. With more lights, this many
  // are chosen with probability proportional to the luminance of their irradiance, and divided by
  // the probability.
  static constexpr int kFirst = 16, kLater = 2;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  std::vector<std::string> groups() const override;

 private:
  explicit PunctualLights(const Scene& scene) : lights_(scene.lights) {}

  DirectionSample sampleOf(size_t i, const LightPoint& point) const;
  void choose(const LightPoint& point, const PixelSampler& sampler, int count,
              std::vector<DirectionSample>& out) const;

  const std::vector<PunctualLight>& lights_;
};

// Suns that a scene has besides its probe (HDRI book, sections 9.3.5 and 9.6.1).

// The camera and mirrors see the visible discs; all other rays find all discs.
class SceneSuns : public LightSource {
 public:
  explicit SceneSuns(const std::vector<SunLamp>& suns);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint&, const vec3& wi) const override { return all_.at(wi); }
  Rgb background(const vec3&, const vec3& wi) const override { return visible_.at(wi).radiance; }
  std::vector<std::string> groups() const override { return names_; }
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  SkyDiscs all_, visible_;
  std::vector<std::string> names_;  // of all
  std::vector<size_t> seen_;        // indices of the visible ones
};

// Constant radiance from all directions, as in light lists (lighting/export/light_file.h).

// Found by BSDF samples only, which for constant radiance are as good as light samples.
class AmbientLight : public LightSource {
 public:
  explicit AmbientLight(const AmbientLamp& lamp) : lamp_(lamp) {}

  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
  Escaped escaped(const LightPoint&, const vec3&) const override { return {lamp_.radiance, 0}; }
  Rgb background(const vec3&, const vec3&) const override {
    return lamp_.isVisible ? lamp_.radiance : Rgb(0);
  }
  std::vector<std::string> groups() const override { return {lamp_.name}; }

 private:
  AmbientLamp lamp_;
};

// Light of several sources: a probe's strategy, and the other sources of a scene.

// Takes the samples of every part. Radiances and pdfs of all parts are added in each direction, so
// that all samples are combined by the balance heuristic (Veach 1997). It can be guided if the
// first part can.
class CombinedLight : public LightSource {
 public:
  // The first part is the probe's.
  explicit CombinedLight(std::vector<std::unique_ptr<LightSource>> parts);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override;
  bool canBeGuided() const override { return parts_.front()->canBeGuided(); }
  bool sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const override;
  float mirrorAlpha() const override { return parts_.front()->mirrorAlpha(); }
  bool unbiased() const override { return parts_.front()->unbiased(); }
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  std::vector<std::unique_ptr<LightSource>> parts_;
  std::vector<size_t> groupCounts_;  // of each part
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Polygons of a probe as sources of their own (HDRI book, section 9.6.1; RADIANCE's "illum").
#pragma once

#include "lighting/light_source.h"
#include "math/cdf.h"
#include "probe/polygon_source.h"
#include "probe/probe.h"

namespace chromeball {

struct PolygonLight {
  PolygonSource source;  // in the frame of the unrotated map
  bool isIllum = true;
  std::string name;
};

// The part of a CombinedLight beside a strategy of the remainder. Takes a sample of one polygon,
// chosen by power, uniform over its solid angle.
//
// An illum is found by its samples only; the camera and mirrors see the probe as it was captured.
// Others are seen by all rays, as polygons of constant radiance, and their samples are weighted
// against BSDF samples. Either way energy is counted once.
class PolygonLights : public LightSource {
 public:
  // `lights` is not empty. `hidden`: the map of the illums, which only the camera and mirrors see:
  // the whole map minus the map without the illums; unrotated.
  PolygonLights(const std::vector<PolygonLight>& lights, const Image& hidden,
                const Rotation& rotation);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override;
  bool sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const override;
  bool unbiased() const override { return false; }

  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  // A sample of a polygon that is not black, from two numbers in [0, 1).
  struct Chosen {
    size_t light;
    vec3 wi;
  };
  Chosen choose(double u, float v) const;
  bool areBlack() const { return choice_.row(0).back() == 0; }
  size_t illumAt(const vec3& wi) const;

  struct Light {
    SphericalPolygon polygon;
    Rgb radiance;
    bool isIllum;
    std::string name;
    float pdf;  // inside the polygon, over solid angle: with the probability of the choice
  };

  std::vector<Light> lights_;
  CdfRows choice_;
  Probe hidden_;
};

}  // namespace chromeball

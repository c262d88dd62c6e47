// SPDX-License-Identifier: Apache-2.0
// Wraps any strategy: the probe is projected onto a surface at a finite distance (HDRI book,
// sections 9.2.3 and 9.6.1).
#pragma once

#include "lighting/strategy.h"
#include "scene/surroundings.h"

namespace chromeball {

// Every point y of the surface emits, in all directions, the radiance that the probe has in the
// direction from the capture point c to y. The wrapped strategy samples directions from c. Seen
// from a point x, the pdf over solid angle is
//   pdf_x = pdf_c (|x - y|^2 / cos_x) / (|c - y|^2 / cos_c),
// with the cosines at y towards x and c (the ratio of the solid angles of a patch at y seen from c
// and from x). Suns and delta lights become lamps on the surface, at different distances from
// different points.
//
// Parts of a room that are hidden from the capture point are not sampled. A BSDF-sampled ray that
// ends there gets the probe's radiance in the direction from c. A light sample on a wall that
// another wall hides from x is dropped.
//
// The camera and mirrors see the probe as captured; lamps made from suns light only broad lobes
// (RADIANCE's "illum"). With `showsLights` they see on the surface what the strategy shows instead
// of the probe: its lights (StrategyOptions::showLights), polygons that are no illums.
class FiniteSurroundings : public WrappedLight {
 public:
  // `room`: replaces the box or sphere of `surroundings` unless null; must outlive this.
  FiniteSurroundings(std::unique_ptr<LightSource> strategy, const Probe& probe,
                     const Surroundings& surroundings, const Walls* room = nullptr,
                     bool showsLights = false)
      : WrappedLight(std::move(strategy)),
        probe_(probe),
        surroundings_(surroundings),
        room_(room),
        showsLights_(showsLights) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  Surroundings::Point behind(const vec3& origin, const vec3& direction) const {
    return room_ ? room_->behind(origin, direction) : surroundings_.behind(origin, direction);
  }
  bool isSeen(const Surroundings::Point& y, const vec3& from) const {
    return !room_ || room_->isSeen(y.position, from);
  }

  // The solid angle of a patch at y seen from x, relative to that from the capture point.
  float solidAngleRatio(const vec3& x, const Surroundings::Point& y) const;

  const Probe& probe_;
  Surroundings surroundings_;
  const Walls* room_;
  bool showsLights_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Any strategy, with the probe on a surface at a finite distance.
#pragma once

#include "lighting/strategy.h"
#include "scene/surroundings.h"

namespace chromeball {

// Every point y of the surface shines with the radiance that the probe has in the direction from
// the capture point c to y, the same towards all sides. The wrapped strategy samples directions
// from c; seen from a point x,
//   density_x = density_c (|x - y|^2 / cos_x) / (|c - y|^2 / cos_c),
// the cosines being those at y of the directions to x and c: solid angles of one patch of surface
// (HDRI book, 9.2.3). What it samples concentrated, suns or delta lights, so becomes a lamp on the
// surface, nearer to some points than to others.
//
// What of a room the capture point does not see, the strategy does not sample; a ray that ends
// there finds what the probe shows in front of it. A sample at a wall that another hides is left
// out.
//
// The camera and mirrors see the probe as it was taken: a lamp that a strategy took out of it
// shines on matte and glossy surfaces only (RADIANCE's "illum"; HDRI book, 9.6.1).
class FiniteSurroundings : public LightingStrategy {
 public:
  // `room` must outlive this; it takes the place of the box or the sphere, and is null where there
  // is one of them.
  FiniteSurroundings(std::unique_ptr<LightingStrategy> strategy, const Probe& probe,
                     const Surroundings& surroundings, const Walls* room = nullptr)
      : strategy_(std::move(strategy)), probe_(probe), surroundings_(surroundings), room_(room) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override;
  float mirrorAlpha() const override { return strategy_->mirrorAlpha(); }
  bool unbiased() const override { return strategy_->unbiased(); }

 private:
  Surroundings::Point behind(const vec3& origin, const vec3& direction) const {
    return room_ ? room_->behind(origin, direction) : surroundings_.behind(origin, direction);
  }
  bool isSeen(const Surroundings::Point& y, const vec3& from) const {
    return !room_ || room_->isSeen(y.position, from);
  }

  // How much larger the solid angle of a patch at y is from x than from the capture point.
  float enlargement(const vec3& x, const Surroundings::Point& y) const;

  std::unique_ptr<LightingStrategy> strategy_;
  const Probe& probe_;
  Surroundings surroundings_;
  const Walls* room_;
};

}  // namespace chromeball

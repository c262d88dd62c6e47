// SPDX-License-Identifier: Apache-2.0
// The pixels around a short arc of a ball's outline, and how likely they make its position.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/capture/photograph.h"

namespace chromeball {

// How radiance changes across the outline. At the distance d from it and t along it, in pixels, it
// is b0 + b1 d + b2 t outside and a0 + a1 s + a2 s^2 + a3 t inside, where s = sqrt(-d): the cosine
// of the angle of incidence on the ball, and with it what it reflects and its Fresnel reflectance,
// is a smooth function of s. The reflected scene is compressed towards the rim. A pixel shows the
// mean over its square, blurred by a Gaussian. (This is the slanted edge of ISO 12233, with a model
// of what is inside.)
//
// Every surface reflects all light at grazing angles, where that light comes from just behind the
// ball: a rim that continues the background so has a0 = b0.
//
// Errors are normal. Their variances differ on both sides of the outline, so that a pattern behind
// the ball hides less of a smooth reflection, and reflected lamps less of a smooth background;
// without noise, one variance is more robust.
struct RimModel {
  double blur = 0;  // standard deviation, in pixels
  bool isContinuous = false;
  bool hasOneVariance = false;
};

class RimArc {
 public:
  // Reads the pixels within `halfAngle` of `angle` (radians) that are at most kRimDepth from the
  // outline when that is at most `reach` from the circle; pixels.
  static constexpr double kRimDepth = 4;
  RimArc(const Image& image, const Circle& circle, double angle, double halfAngle, double reach);

  const glm::dvec2& normal() const { return normal_; }
  size_t pixels() const { return pixels_.size(); }

  // Minus the logarithm of the likelihood of the outline at `offset` from the circle, outwards,
  // with the most likely unknowns of the model.
  double doubt(const RimModel& model, double offset) const;

 private:
  struct Pixel {
    glm::dvec3 radiance;
    double distance, along;  // of its centre: from the circle, outwards, and from the arc's middle
  };
  glm::dvec2 normal_;
  std::vector<Pixel> pixels_;
  double meanSquare_ = 0;  // of radiance
};

}  // namespace chromeball

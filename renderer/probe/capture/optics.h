// SPDX-License-Identifier: Apache-2.0
// Which direction each point of a photograph's circle shows: on a mirror ball, or through a fisheye
// lens.
#pragma once

#include <optional>

#include "math/vec.h"
#include "probe/fisheye.h"

namespace chromeball {

// How much light a mirror ball reflects.

// Index of refraction n + ik of a metal.
struct MetalIndex {
  double n, k;
};

// The reflectance of unpolarised light by a metal in air, exactly (Born and Wolf, section 14.2).
double metalFresnel(double cosIncidence, const MetalIndex& index);

// Reflectance of linear Rec. 709 by a ball.
class BallReflectance {
 public:
  // The same reflectance at all angles.
  explicit BallReflectance(const glm::dvec3& reflectance = glm::dvec3(1)) : normal_(reflectance) {}

  // A reflectance measured at normal incidence, which changes with the angle like a metal's.
  static BallReflectance ofMetal(const glm::dvec3& normal, const MetalIndex& index);
  // The same by Schlick's approximation (1994), which rises to 1 at the rim: for rendered balls.
  static BallReflectance schlick(const glm::dvec3& normal);

  glm::dvec3 at(double cosIncidence) const;

 private:
  glm::dvec3 normal_;
  bool isSchlick_ = false;
  std::optional<MetalIndex> index_;
};

using glm::dvec2;
using glm::dvec3;

// Where a photograph shows a direction.
struct DiscPoint {
  dvec2 position;     // x right, y up; the circle has radius 1
  double weight;      // how well it is shown, above 0 to 1: for a mean over several photographs
  dvec3 reflectance;  // the photograph's radiance / the direction's
};

// Directions are unit, in the camera's frame: x right, y up, z backwards, towards the camera.
class CaptureOptics {
 public:
  virtual ~CaptureOptics() = default;
  virtual std::optional<DiscPoint> locate(const dvec3& direction) const = 0;  // nullopt: not shown

  // The solid angle that the circle shows, over the whole sphere's.
  virtual double shareShown() const = 0;
};

// A mirror ball seen by a camera that looks at its centre. A point at radius r of the disc, which
// is seen at the angle b from the axis, has the angle of incidence i with sin(i) = d sin(b), where
// d is the distance of the camera from the centre in radii; the normal is at i - b from the axis,
// and the reflected direction at 2i - b from the direction towards the camera. So the centre shows
// the camera, and the right of the photograph the camera's right. The cone of half angle asin(1/d)
// behind the ball is not shown.
class BallOptics : public CaptureOptics {
 public:
  // `distance` is above 1; infinite for a parallel projection. Directions within `cameraDisc`
  // degrees of the camera, where it and its operator are reflected, have less weight than in any
  // other photograph.
  BallOptics(double distance, const BallReflectance& reflectance, double cameraDisc);

  // The weight is smoothstep(cos(i)): images of lengths at the angle 2i from the camera shrink by
  // cos(i) along the radius (HDRI book, section 9.3.1: blind spots).
  std::optional<DiscPoint> locate(const dvec3& direction) const override;
  double shareShown() const override;

  // The direction that a point of the disc shows, and the cosine of the angle of incidence there.
  struct Reflection {
    dvec3 direction;
    double cosIncidence;
  };
  Reflection reflection(const dvec2& position) const;

 private:
  double angleOfIncidence(double fromCamera) const;

  double inverseDistance_;
  BallReflectance reflectance_;
  double cameraDisc_;  // radians
};

// A fisheye lens: the centre shows the direction in which the camera looks. The weight falls
// towards the rim.
class FisheyeOptics : public CaptureOptics {
 public:
  explicit FisheyeOptics(const Fisheye& lens) : lens_(lens) {}
  std::optional<DiscPoint> locate(const dvec3& direction) const override;
  double shareShown() const override;

 private:
  Fisheye lens_;
};

}  // namespace chromeball

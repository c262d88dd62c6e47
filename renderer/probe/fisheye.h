// SPDX-License-Identifier: Apache-2.0
// Fisheye lenses: images whose centre shows the lens's axis, and whose radius is a function of the
// angle from it.
#pragma once

#include <string>
#include <string_view>

namespace chromeball {

// The radius r of the image of a direction at the angle t from the axis; r is 1 at the rim, where t
// is half of the field of view, h.
enum class FisheyeProjection {
  Equidistant,    // r = t / h
  Equisolid,      // r = sin(t/2) / sin(h/2): equal solid angles have equal areas
  Orthographic,   // r = sin(t) / sin(h), up to 180 degrees
  Stereographic,  // r = tan(t/2) / tan(h/2), up to 300 degrees
};

struct Fisheye {
  double fieldOfView = 180;  // of the disc's diameter, in degrees
  FisheyeProjection projection = FisheyeProjection::Equidistant;

  double halfAngle() const;   // in radians
  double solidAngle() const;  // of the field of view

  // Converts the angle to the axis (radians, 0 to pi) to the radius, and the radius (0 to 1) to the
  // angle. Outside the field of view the radius is above 1.
  double radius(double angle) const;
  double angle(double radius) const;

  // d(solid angle) / d(area), where the disc has radius 1.
  double solidAngleJacobian(double radius) const;

  bool operator==(const Fisheye&) const = default;
};

// "fisheye:180:equidistant".
std::string fisheyeName(const Fisheye& lens);

// Whether `name` is "fisheye", or begins so with a colon after it.
bool namesFisheye(std::string_view name);

// Parses "fisheye[:FIELD_OF_VIEW[:PROJECTION]]": at least 60 degrees; 180 degrees and equidistant
// if left out. Throws InputError, begun by `location`.
Fisheye parseFisheye(std::string_view name, std::string_view location);

}  // namespace chromeball

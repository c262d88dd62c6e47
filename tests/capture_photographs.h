// SPDX-License-Identifier: Apache-2.0
// Photographs of a mirror ball under a probe, by rays that are intersected with a sphere and
// reflected: without the formulas of probe/capture/optics.h.
#pragma once

#include <functional>
#include <limits>

#include "probe/capture/match_views.h"
#include "probe/probe.h"

namespace chromeball {

inline constexpr double kParallel = std::numeric_limits<double>::infinity();

struct BallScene {
  const Probe& probe;
  double distance = kParallel;  // of the camera, in radii
  CameraPosition camera;
  BallReflectance reflectance{};
  int samples = 6;       // along the side of a pixel
  float background = 1;  // around the ball, times the probe's mean radiance of 1
};

// The directions of a camera's axes.
struct CameraAxes {
  dvec3 right, up, backwards;

  explicit CameraAxes(const CameraPosition& camera);
};

// The radiance along the ray through (x, y) of the picture, in radii of the ball's outline from its
// centre.
dvec3 ballRadiance(const BallScene& scene, const dvec2& p);

Image photographOf(const std::function<dvec3(const dvec2&)>& radiance, int width, int height,
                   const Circle& circle, int samples);

Image photographOf(const BallScene& scene, int width, int height, const Circle& circle);

// The mean over many normals of the largest channel's error of irradiance, over the mean
// irradiance; and the largest.
struct IrradianceError {
  double mean = 0, largest = 0;
};
IrradianceError irradianceError(const Image& map, const Image& truth, int subdivisions = 3);

}  // namespace chromeball

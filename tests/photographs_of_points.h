// SPDX-License-Identifier: Apache-2.0
// Known cameras, and the points that they see: computed here, independently of the library.
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "scene/solve/observations.h"
#include "scene/solve/solve_camera.h"

namespace chromeball {

SolvedCamera photographFrom(const dvec3& position, const dvec3& target, double fovDegrees,
                            double k1 = 0, const ImageSize& size = {1600, 1200});

// nullopt behind the camera and outside the picture.
std::optional<dvec2> pixelOf(const SolvedCamera& camera, const dvec3& point);

// `count` points of a box of half sizes `half` that the camera sees, with normally distributed
// errors of `noise` pixels in each coordinate.
std::vector<ObservedPoint> observe(const SolvedCamera& camera, size_t count, const dvec3& half,
                                   double noise, std::mt19937& random);

// The vector whose rotation, about the axes of `a`, turns `a` into `b`; for small ones.
dvec3 turnBetween(const glm::dmat3& a, const glm::dmat3& b);

}  // namespace chromeball

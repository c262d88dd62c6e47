// SPDX-License-Identifier: Apache-2.0
// A photograph of a diffuse ball, as measurements of irradiance.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "image/image.h"
#include "probe/capture/photograph.h"
#include "probe/mapping.h"

namespace chromeball {

struct DiffuseBall {
  Circle circle;  // its outline, in pixels from the top left corner
  dvec3 paint;    // reflectance, above 0
  CameraPosition camera = {};
  double distance = std::numeric_limits<double>::infinity();  // to its centre, in radii; above 1

  // The normal (unit) at a point of the circle, x right and y up, of radius 1.
  dvec3 normalAt(const dvec2& point) const;
};

// A pixel, or the mean of a block of them.
struct BallSample {
  int x, y;        // of the block, from the top left corner of the circle's square
  vec3 normal;     // in the world
  dvec3 radiance;  // of a white ball: the photograph's / paint
};

struct BallSamples {
  std::vector<BallSample> samples;
  int side = 0;        // blocks across the circle's square
  int block = 1;       // pixels across a block: the circle's radius is at most 128 blocks
  size_t invalid = 0;  // pixels that are not finite or negative: their blocks are left out
};

// The blocks that are inside the circle. `photograph` is linear; `excluded` (one channel, of its
// size; empty: nothing) is above 0.5 where pixels do not count. Throws InputError, begun by `name`,
// if the circle is not inside the photograph, or fewer than a hundred blocks are left.
BallSamples sampleBall(const DiffuseBall& ball, const Image& photograph, const Image& excluded,
                       const std::string& name);

}  // namespace chromeball

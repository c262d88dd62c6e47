// SPDX-License-Identifier: Apache-2.0
// Correlates two maps under rotations of one of them (align.h).
#pragma once

#include <vector>

#include "image/image.h"
#include "math/vec.h"
#include "probe/probe.h"

namespace chromeball {

// Two lat-long maps f and g of the same size with a mean of 0 over the sphere in each of three
// channels. A rotation R of g makes it g(R^-1 d).
class MapPair {
 public:
  MapPair(const Image& f, const Image& g);

  // The correlation of f and the rotated g over the sphere, over all channels together; from -1 to
  // 1, and 0 if a map is 0. The power of g is computed from its texels: an interpolated g has less
  // power, depending on R.
  double correlation(const glm::dquat& rotation) const;

  // The maximum of the correlation next to a rotation, to 1e-3 texels: Gauss-Newton steps, each
  // shortened until the correlation grows.
  glm::dquat refined(glm::dquat rotation) const;

  // Standard errors of a maximum about X, Y and Z, in radians: valid for residuals that depend on
  // each other within each of the 80 faces of an icosphere ("sandwich" estimate; Liang and Zeger,
  // "Longitudinal Data Analysis Using Generalized Linear Models", 1986).
  glm::dvec3 standardErrors(const glm::dquat& rotation) const;

 private:
  struct Sums;
  Sums sumsAt(const glm::dquat& rotation) const;
  struct Texel {
    vec3 direction;
    Rgb f;
    float solidAngle;
  };
  // Calls visit(texel, index of its row) for each texel of f, rows in parallel.
  template <class Visit>
  void forTexels(const Visit& visit) const;
  // g and its derivatives by rotations of the map about X, Y and Z, in each channel.
  struct Seen {
    glm::dvec3 g, derivatives[3];
  };
  Seen seenAt(const mat3& back, const vec3& direction) const;

  int width_, height_;
  std::vector<Texel> texels_;  // of f, row by row
  Probe g_;
  double texel_;            // height, radians
  double powerF_, powerG_;  // integrals of the squares over the sphere
};

// A probe's log radiance, in which two probes of one place are compared (align.h).

// Makes log maps of any size of one lat-long map, which must outlive this. In each channel a log
// map is log(radiance / m + 1/20), m the channel's median over the sphere, blurred by a Gaussian
// whose sigma is the height of a texel, minus its mean over the sphere. So it does not depend on
// exposure and white balance, and is dominated neither by suns nor by dark noise. The blur is there
// for bilinear interpolation: it would make noise weaker between texels than at their centres.
class LogMaps {
 public:
  explicit LogMaps(const Image& latLong);

  // 2 x `height` by `height` texels.
  Image map(int height) const;

 private:
  const Image& latLong_;
  Rgb unit_;  // m; 1 where that is 0
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A photograph of a part of the surroundings, with a known camera direction.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"

namespace chromeball {

struct Tile {
  std::string name;  // begins a message about it
  Image image;       // radiance, three channels; perspective, the axis in the middle
  Rotation pose;     // takes the camera's axes to the world's: it looks along -Z, with +Y up
  double fov;        // vertical field of view, degrees, above 0 and below 180
};

// The directions that a tile's pixels show.
class TileView {
 public:
  // `tile` must outlive this.
  explicit TileView(const Tile& tile);

  struct Seen {
    Rgb radiance{0};   // bilinear between the centres of pixels
    float weight = 0;  // cosine window: 1 in the middle, 0 at the edges and outside
  };
  // What the tile shows in a direction, for its pose or another.
  Seen at(const glm::dvec3& direction) const { return at(direction, pose_); }
  Seen at(const glm::dvec3& direction, const glm::dquat& pose) const;

  double pixelAngle() const;  // of a pixel in the middle, radians

 private:
  const Image& image_;
  glm::dquat pose_;
  double halfWidth_, halfHeight_;  // at distance 1
};

// Directions that two tiles see.

struct Overlap {
  int first, second;  // indices of two tiles
  glm::dvec3 direction;
  float weight;  // product of both windows, times the solid angle
};

// The overlaps at the texel centres of a lat-long map of this height, row by row.
std::vector<Overlap> overlapsOf(std::span<const TileView> views, int height);

}  // namespace chromeball

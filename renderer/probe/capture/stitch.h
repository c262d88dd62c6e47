// SPDX-License-Identifier: Apache-2.0
// Stitches photographs of known direction to a probe (HDRI book, section 9.3.2, figure 9.11).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

// A photograph of a part of the surroundings, with a known camera direction.
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

struct StitchedProbe {
  Image latLong;     // black where no tile looks
  double uncovered;  // that part of the sphere, as a fraction
};

// Each direction has the mean of the tiles that see it, weighted by their windows (TileView);
// `gains` (one per tile) are factors on their radiance.
StitchedProbe stitch(const std::vector<Tile>& tiles, const std::vector<double>& gains,
                     const ImageSize& size);

// The size of a lat-long map whose texels are no coarser than the pixels in the middle of a tile,
// with at most 8192 rows.
ImageSize stitchedSize(const std::vector<Tile>& tiles);

// Factors that make the tiles agree where they overlap: least squares over the logarithms of all
// pairs' median luminance ratios, weighted by solid angle; their product is 1. Throws InputError if
// a tile is not connected to the first by overlaps in which both are lit.
std::vector<double> tileGains(const std::vector<Tile>& tiles);

// The changes by refinePoses().
struct PoseRefinement {
  std::vector<double> turns;  // of each tile, degrees
  double before, after;       // RMS of the difference of log radiance in overlaps
};

// Turns all tiles but the first until they agree best where they overlap: Gauss-Newton steps on the
// differences of log radiance, weighted by both windows, with images reduced to 64 rows at first
// and to at most 512 at last. Poses should be within some degrees. Throws as tileGains(), and
// InputError if the overlaps leave a pose undetermined. A single tile stays as it is.
PoseRefinement refinePoses(std::vector<Tile>& tiles);

}  // namespace chromeball

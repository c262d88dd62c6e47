// SPDX-License-Identifier: Apache-2.0
// Stitches photographs of known direction to a probe (HDRI book, section 9.3.2, figure 9.11).
#pragma once

#include <vector>

#include "probe/capture/tile.h"
#include "probe/mapping.h"

namespace chromeball {

struct StitchedProbe {
  Image latLong;     // black where no tile looks
  double uncovered;  // that part of the sphere, as a fraction
};

// Each direction has the mean of the tiles that see it, weighted by their windows (TileView);
// `gains` (one per tile) are factors on their radiance.
StitchedProbe stitch(const std::vector<Tile>& tiles, const std::vector<double>& gains,
                     const ImageSize& size);

// The size of a lat-long map whose texels are no coarser than the pixels in the middle of a tile.
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

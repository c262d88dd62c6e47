// SPDX-License-Identifier: Apache-2.0
// One row of the probe as `importance` samples it, for a plot (HDRI book, figure 9.36).
#pragma once

#include <string_view>
#include <vector>

#include "lighting/importance.h"

namespace chromeball {

// Azimuths are in degrees from -Z, counter-clockwise seen from above; so they decrease to the right
// in the map, and `left` is the greater one.
struct AzimuthRange {
  double left = 180, right = -180;  // at most 360 apart
};

// The row of cells between the centres of texel rows `texelRow` and `texelRow` + 1 (-1: the cells
// from the pole), and the one at an elevation in degrees.
inline int cellRowBelow(int texelRow) { return texelRow + 1; }
int cellRowAt(const Probe& probe, double elevation);

// Consecutive cells of a row, from left to right; each edge between cells is at a texel's centre.
struct RowDistribution {
  int row;                         // of cells: importance.h
  double elevation;                // of its middle, degrees
  double share;                    // of the row's samples that fall between the first and last edge
  std::vector<double> azimuths;    // of the edges, decreasing from the left; one more than cells
  std::vector<double> luminances;  // mean of a cell's corners
  std::vector<double> cdf;         // at the edges: the sampler's, scaled to go from 0 to 1

  // A sample that `importance` draws: from `number` of this cdf, to an azimuth between the edges.
  struct Sample {
    double number, azimuth;
  };
  std::vector<Sample> samples;
};

// The cells that cover the range, and `count` samples, of the numbers (i + 1/2) / count. Throws
// InputError, begun by `location`, if no light is sampled there, or it is near the largest float.
RowDistribution rowDistribution(const Probe& probe, const Importance& importance, int row,
                                const AzimuthRange& range, int count, std::string_view location);

}  // namespace chromeball

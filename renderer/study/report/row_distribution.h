// SPDX-License-Identifier: Apache-2.0
// One row of the probe as `importance` samples it, for a plot (HDRI book, figure 9.36).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lighting/importance.h"

namespace chromeball {

// Azimuths are in degrees from -Z, counter-clockwise seen from above; so they decrease to the right
// in the map, and `left` is the greater one.
struct AzimuthRange {
  double left = 180, right = -180;  // at most 360 apart
};

// The probe of these functions is not tilted: its rows have constant elevation.

// The row of texels that an elevation in degrees falls on, and the row that is sampled most.
int texelRowAt(const Probe& probe, double elevation);
int brightestRow(const Probe& probe, const Importance& importance);

// Consecutive texels of a row, from left to right, and the pdf of `importance` over azimuth along
// the middle of the row: linear between the centres of texels.
struct RowDistribution {
  int row;                         // of texels, from 0 at the top
  double elevation;                // of its middle, degrees
  double share;                    // of the row's samples that fall between the first and last edge
  std::vector<double> azimuths;    // of the edges, decreasing from the left; one more than texels
  std::vector<double> luminances;  // of the texels
  std::vector<double> cdf;         // at the edges, scaled to go from 0 to 1

  // A sample of that pdf: from `number` of this cdf, to an azimuth between the edges.
  struct Sample {
    double number, azimuth;
  };
  std::vector<Sample> samples;
};

// The texels that cover the range, and `count` samples, of the numbers (i + 1/2) / count. Throws
// InputError, begun by `location`, if no light is sampled there.
RowDistribution rowDistribution(const Probe& probe, const Importance& importance, int row,
                                const AzimuthRange& range, int count, std::string_view location);

// A plot of how `importance` samples one row of a probe, as SVG (HDRI book, figure 9.36).

// A self-contained SVG, from top to bottom over a common azimuth: the luminance of the row's
// texels, on a logarithmic scale above 0; its cdf, with an arrow for each sample from its number to
// its azimuth; and the part of the probe around the row, tone mapped, with a mark for each sample.
std::string rowPlot(const Probe& probe, const RowDistribution& row, const std::string& title);

}  // namespace chromeball

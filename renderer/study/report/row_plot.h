// SPDX-License-Identifier: Apache-2.0
// A plot of how `importance` samples one row of a probe, as SVG (HDRI book, figure 9.36).
#pragma once

#include <string>

#include "study/report/row_distribution.h"

namespace chromeball {

// A self-contained SVG, from top to bottom over a common azimuth: the luminance of the row's
// texels, on a logarithmic scale above 0; its cdf, with an arrow for each sample from its number to
// its azimuth; and the part of the probe around the row, tone mapped, with a mark for each sample.
std::string rowPlot(const Probe& probe, const RowDistribution& row, const std::string& title);

}  // namespace chromeball

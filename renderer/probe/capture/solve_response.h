// SPDX-License-Identifier: Apache-2.0
// A camera's response from photographs of one view that differ in exposure.
#pragma once

#include <span>

#include "probe/capture/exposure.h"
#include "probe/capture/response_curve.h"

namespace chromeball {

// Debevec and Malik (1997), eq. 3: the curve g, one for each channel, for which the exposures of a
// pixel agree best, in the sense of least squares, weighted by a hat; with `smoothness` times g''
// squared. Where the paper chooses pixels, about a million are used here, so their data count as if
// there was one pixel for each of the 256 levels. g is fixed at level 128, where it is that of sRGB
// in all channels: the scale of each channel cannot be determined.
//
// Where all exposures differ by powers of one ratio, as brackets do, ln L may also be changed by
// any function that repeats itself with that ratio: only smoothness decides. With 20, the responses
// of cameras (sRGB, powers, S-shaped) are found within a level from 8-bit photographs with a noise
// of 1.5 levels; that of linear 8-bit files only from irregular exposures.
//
// The levels are multiples of 1/255. Throws InputError if no level is well exposed in two images of
// different exposure, and if the curve that fits best is not increasing.
ResponseCurve solveResponse(std::span<const Exposure> exposures, double smoothness);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The best of several filtered images at each pixel, by estimates of their errors.
#pragma once

#include <vector>

#include "denoise/filter.h"

namespace chromeball {

// No filter; a regression of narrow or wide bandwidth; an average.
enum class FilterKind { None, Narrow, Wide, Average };

// An image, and unbiased but noisy estimates of the squared errors of its pixels: squared bias and
// variance together, and the variance alone.
struct Candidate {
  RgbPlanes color{}, error{}, variance{};
  FilterKind filter = FilterKind::None;
};

// The noisy image itself.
Candidate unfiltered(const Component& component);

// The mean of the filtered halves f. With c the noisy halves, whose noise is independent of each
// other's,
//   E (f0 - c1)^2 = error of f0 + var c1,
//   var c1 = E (c0 - c1)^2 / 2,   var f0 = E (f0 - f1)^2 / 2,
// and the error of the mean is the mean error of f0 and f1 less half the variance of either
// (Bitterli et al. 2016, section 5.3).
Candidate filtered(const Component& component, const HalfPlanes& halves, FilterKind filter);

// The mean of squared errors over the window around each pixel of an image: the lesser of the
// absolute and the relative mean. Absolute errors would spread from bright pixels to dark ones, and
// relative ones from dark pixels to bright ones.
Plane averageErrors(const Plane& squaredErrors, const Plane& color, int reach);

// An image, and its squared errors, averaged over windows.
struct Selection {
  RgbPlanes color, error;
};

// Selects, at each pixel, the first candidate that no later one significantly improves on, on
// average over the window around the pixel; blends where the choice changes. One or more candidates
// are narrow, and the last is the unfiltered image.
Selection best(const std::vector<Candidate>& candidates);

}  // namespace chromeball

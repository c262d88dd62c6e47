// SPDX-License-Identifier: Apache-2.0
// The formulas of differential rendering (HDRI book, 9.7.1).
#pragma once

#include "composite/differential_film.h"
#include "film/noise.h"
#include "image/image.h"

namespace chromeball {

enum class CompositeMode { Difference, Ratio };

// Plate and objects in one picture. With alpha the fraction of samples that see an object, and
// L_obj, L_noobj those of the other samples alone (so that edges are right):
//   Difference  alpha L_objects + (1 - alpha) (plate + L_obj - L_noobj), not below 0
//   Ratio       alpha L_objects + (1 - alpha) plate L_obj / L_noobj
// A ratio to almost no light is noise: where L_noobj of a colour channel is below 0.002 times the
// picture's mean L_noobj, the ratio blends into the difference, which it is below 0.001 times.
// Where objects change nothing, both are exactly the plate.
struct Composite {
  Image color;
  Image gain;                  // by which L_obj - L_noobj was multiplied, before (1 - alpha)
  size_t darkerThanBlack = 0;  // pixels that the difference would have made negative; they are 0
};
// `mean`: of the integrator's samples.
Composite compose(const DifferentialFilm& film, const Image& mean, const Image& plate,
                  CompositeMode mode);

// The composite's luminances and errors, from those of the difference formula's; for the ratio to
// first order, L_noobj taken as known.
PixelErrors compositeErrors(const DifferentialFilm& film, const Composite& composite,
                            PixelErrors errors);

}  // namespace chromeball

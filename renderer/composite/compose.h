// SPDX-License-Identifier: Apache-2.0
// The formulas of differential rendering (HDRI book, 9.7.1).
#pragma once

#include "composite/differential_film.h"
#include "composite/modes.h"
#include "film/noise.h"
#include "image/image.h"

namespace chromeball {

// The composite image. With alpha the fraction of samples that see an object, L_objects the
// radiance of these samples, and L_obj, L_noobj the radiance of the other samples with and without
// the objects (so that edges are right):
//   Difference  max(alpha L_objects + (1 - alpha) (plate + L_obj - L_noobj), 0)
//   Ratio       alpha L_objects + (1 - alpha) plate L_obj / L_noobj
// The ratio is noisy where L_noobj is small. Per colour channel, with M the image's mean L_noobj:
// from 0.002 M down to 0.001 M the ratio blends into the difference, and below 0.001 M the
// difference is used. Both equal the plate exactly where objects have no effect.
//
// ShadowCatcher has no plate: premultiplied colour and alpha A, to be laid over any. With m the
// least of 1 and the channels of L_obj / L_noobj,
//   A = 1 - (1 - alpha) m, color = alpha L_objects + (1 - alpha) (L_obj - m L_noobj),
// so that color + (1 - A) L_noobj is exactly alpha L_objects + (1 - alpha) L_obj: shadows are in
// alpha, and the colour has what the objects reflect onto the local scene.
struct Composite {
  Image color;                 // RGB; RGBA for a shadow catcher
  Image gain;                  // factor of L_obj - L_noobj, without (1 - alpha)
  size_t darkerThanBlack = 0;  // number of pixels with negative results, which are set to 0
};
// `mean`: the mean of the integrator's samples. `plate`: empty for a shadow catcher.
Composite compose(const DifferentialFilm& film, const Image& mean, const Image& plate,
                  CompositeMode mode);

// The luminances and errors of the composite. `errors`: those of the difference formula. For the
// ratio they are propagated to first order, with L_noobj treated as exact.
PixelErrors compositeErrors(const DifferentialFilm& film, const Composite& composite,
                            PixelErrors errors);

}  // namespace chromeball

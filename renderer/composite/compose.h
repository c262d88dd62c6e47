// SPDX-License-Identifier: Apache-2.0
// The formulas of differential rendering (HDRI book, 9.7.1).
#pragma once

#include "composite/layers.h"
#include "composite/render_composite.h"
#include "denoise/denoise.h"
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

// The luminances and errors of the composite. `errors`: the difference formula's. For the ratio
// they are propagated to first order, with L_noobj treated as exact.
PixelErrors compositeErrors(const DifferentialFilm& film, const Composite& composite,
                            PixelErrors errors);

// Removes the noise of the light that the objects add to a composite; the plate is not filtered.

// The composite of the denoised radiance of the objects and of the denoised difference L_obj -
// L_noobj; for the ratio, L_noobj is denoised too. Alpha stays as it is. A pixel keeps the plate's
// bits where neither it nor a pixel around it (7 columns and rows) is affected by the objects, and
// where the camera sees no surface. A shadow catcher has no plate, which is empty. `render` must
// have been made with `denoise`. nullopt if `stop` is set meanwhile.
std::optional<Denoised> denoiseComposite(const RenderResult& render, const Image& plate,
                                         CompositeMode mode, const Progress& progress,
                                         const std::atomic<bool>& stop);

}  // namespace chromeball

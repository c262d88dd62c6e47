// SPDX-License-Identifier: Apache-2.0
// The plate: the background photograph of a composite.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "math/vec.h"
#include "scene/bounds.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace chromeball {

// Linear radiance, three channels. Files of integers are decoded from sRGB unless they state
// another curve. `messages` gets the reader's, `decoding` how integers were decoded. Throws
// InputError if the file is not an image or has a pixel that is not finite.
Image readPlate(const std::string& path, Messages* messages = nullptr,
                Messages* decoding = nullptr);

// Resamples with a box filter. The aspect ratios must agree to within half a pixel of either
// dimension, otherwise throws InputError (message beginning with `name`). An image of the requested
// size is returned unchanged.
Image scaledPlate(const Image& image, int width, int height, const std::string& name);

// The factor between a probe and a photograph of the same place, by the ground in the photograph.

struct PlateScale {
  Rgb scale{1};        // factor on the probe's radiance
  Rgb reflectance{0};  // of the ground, assumed
  double scatter = 0;  // of the ground's luminance: half the span of 68% of its pixels / median
  size_t pixels = 0;   // that show the ground
};

// The pixels, as indices into the plate, whose middle shows the node `ground` of the local scene,
// at a point that `part` holds, seen from above.
std::vector<size_t> pixelsThatShow(int ground, const Bounds& part, const Scene& localScene,
                                   const Camera& camera, int width, int height);

// The pixels whose middle lies in a part of an image, in fractions of its width and height: left,
// top, right, bottom.
std::vector<size_t> pixelsIn(const vec4& part, int width, int height);

// The reflectance of the ground in a photograph that shows a white surface in the ground's light as
// 1: the median luminance. Typical exposures come near; `range` bounds it.
float reflectanceInPhotograph(const Image& plate, const std::vector<size_t>& pixels,
                              const vec2& range);

// The scale at which a matte ground of this reflectance has the median radiance of the plate: per
// channel pi L / (reflectance E), with E the irradiance of the ground by the probe with scale 1,
// W/m^2. Medians, since other things may stand on the ground. `pixels` not empty; E and the
// reflectance above 0.
PlateScale scaleByPlate(const Image& plate, const std::vector<size_t>& pixels,
                        const Rgb& irradiance, const Rgb& reflectance);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Synthetic lat-long probes, for tests and for lighting without a photograph; the clear sky is in
// sky.h.
#pragma once

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

Image constantProbe(const ImageSize& size, const Rgb& radiance);

// Black except for one texel.
Image oneHotProbe(const ImageSize& size, int x, int y, const Rgb& radiance);

// radiance x (1 + slope . D) at each texel's centre; |slope| <= 1 keeps it positive. The mean is
// `radiance`; the irradiance on a plane with unit normal n is pi radiance (1 + 2/3 slope . n).
Image gradientProbe(const ImageSize& size, const Rgb& radiance, const dvec3& slope);

// CIE standard overcast sky (Moon and Spencer 1942): zenith (1 + 2 sin(elevation)) / 3, above a
// Lambertian ground lit by the sky's irradiance, zenith 7 pi / 9.
Image overcastProbe(const ImageSize& size, const Rgb& zenith, double groundAlbedo);

// A photographer's studio: a key light of 30 on the right, a fill of 8 on the left, a rim strip of
// 15 behind and an overhead panel of 10, in a room of 0.02.
Image studioProbe(const ImageSize& size);

}  // namespace chromeball

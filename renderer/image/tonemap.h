// SPDX-License-Identifier: Apache-2.0
// Tone mapping: from linear radiance to display colours.
#pragma once

#include <string_view>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// The sRGB transfer function (IEC 61966-2-1) and its inverse; odd about 0, so negative values keep
// their sign.
float linearToSrgb(float linear);
float srgbToLinear(float encoded);

enum class ToneOperator {
  None,        // clips at 1
  Reinhard,    // luminance Y becomes Y (1 + Y/16) / (1 + Y): Reinhard et al. 2002, eq. 4, white 4
  Aces,        // fit of the ACES RRT and ODT: Hill, "BakingLab", 2016
  PbrNeutral,  // Khronos PBR Neutral, 2024: preserves hue and saturation of colours below 0.8
  Filmic,      // Hable, "Uncharted 2", GDC 2010; white 11.2
};

// none, reinhard, aces, neutral or filmic. Throws InputError with the nearest name for any other.
ToneOperator parseToneOperator(std::string_view name);
const std::vector<std::string_view>& toneOperatorNames();  // in the order of the enumeration

struct DisplayTransform {
  ToneOperator tone = ToneOperator::None;
  float exposure = 0;  // stops: radiance is multiplied by 2^exposure
  Rgb balance{1};      // and by this
};

// The factors on red, green and blue that make a light white and keep its luminance.

// Of a light of this colour, with channels above 0.
Rgb balanceOf(const Rgb& light);
inline constexpr double kLeastKelvin = 2000, kMostKelvin = 25000;
// Of a black body, relative to one of 6504 K, the correlated temperature of our white, D65: 6504
// changes nothing. Kim et al. 2002, "Design of advanced color temperature control system for HDTV
// applications", eq. 10 and 11.
Rgb balanceOf(double kelvin);

// Display-linear colour in [0, 1]. NaN and negative channels count as 0.
Rgb display(const DisplayTransform& transform, const Rgb& radiance);

// The exposure that shows a picture's surfaces well: as a camera's meter would choose it.

// Stops, in steps of 0.1, so that the logarithmic mean of the surfaces' luminances (Reinhard et al.
// 2002, "Photographic tone reproduction for digital images", eq. 1) becomes 0.25, as far as at most
// a twentieth of them clips in a channel; for that the picture becomes at most 1.5 stops darker,
// unless more than a quarter would clip.
// Surfaces are the pixels whose `coverage`, of one channel, is at least a half; all pixels if there
// are none, or if `coverage` is empty. Pixels that are black, infinite or NaN are left out, and
// from the mean also the 2% at either end: few pixels decide nothing. 0 if nothing remains.
float autoExposure(const Image& radiance, const Image& coverage = {});

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The sum of a light stage's pictures under a probe, of the pictures themselves or of transformed
// ones (HDRI book, section 9.9.2, Figure 9.45; Ng et al. 2003).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "relight/stage/light_stage.h"

namespace chromeball {

// Transforms over the elements, each orthonormal: they keep the sum of products of two vectors.
enum class RelightDomain {
  Pixel,  // none
  Dct,    // cosines of 8 x 8 blocks of the boxes of a lat-long map
  Haar,   // wavelets of each of a cube's faces
  Sh      // none; the elements are spherical harmonics
};

// "pixel", "dct", "haar", "sh"; and "auto": sh for harmonics, pixel for cells. Throws InputError,
// begun by --domain, for a name that is unknown or does not suit the basis.
RelightDomain parseDomain(const std::string& name, const DirectionBasis& basis);

// A pixel's elements, or the weights of a probe, in place.
void transform(std::span<Rgb> values, const DirectionBasis& basis, RelightDomain domain);

// The numbers of colours: channels alternate.
inline std::span<float> floatsOf(std::vector<Rgb>& colors) {
  return {reinterpret_cast<float*>(colors.data()), 3 * colors.size()};
}
inline std::span<const float> floatsOf(std::span<const Rgb> colors) {
  return {reinterpret_cast<const float*>(colors.data()), 3 * colors.size()};
}

// Sum of values times weights, of colours.
Rgb product(std::span<const float> values, std::span<const float> weights);

// Sum over the elements of element times weight, without the scene's own light.
Image weightedSum(const Image& elements, std::span<const Rgb> weights);

// `own`: LightStage::own, which may be empty.
void addOwnLight(Image& sum, const Image& own);

// Root of the sum of squared differences, divided by that of the squares of `whole`; 0 if that is
// black.
double relativeDifference(const Image& part, const Image& whole);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A light stage under a probe, from all its numbers or only the largest (HDRI book, section 9.9.2,
// Figure 9.45; Ng et al. 2003).
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relight/stage/light_stage.h"
#include "relight/stage/stage_file.h"

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

// Colours as numbers: channels alternate.
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

// Root of the sum of squared differences over the sum of squares of `whole`; 0 if `whole` is black.
double relativeDifference(const Image& part, const Image& whole);

// The shares of the numbers in the domain that are kept, those of largest magnitude.
struct KeptShares {
  double stage = 1, light = 1;  // above 0, up to 1

  bool isAll() const { return stage == 1 && light == 1; }
};

struct RelitStage {
  Image picture;  // with the scene's own light
  // If not all numbers are kept: shares of numbers that are zeros, and relativeDifference() of the
  // sums.
  double zeros = 0, lightZeros = 0, error = 0;
};

// The sum over the elements of element times weight, in a domain. A stage of several bands is read
// twice if some of it is left out. The bits do not depend on the bands.
RelitStage relitStage(StageBands& stage, const std::vector<Rgb>& weights, RelightDomain domain,
                      const KeptShares& kept);

// The most memory that this takes besides the bands, with the picture's file, in bytes.
double relitStageBytes(int width, int height);

// Keeps the numbers of largest magnitude, out of more numbers than memory may hold.

// A histogram of magnitudes. Bins are 2^-11 wide, relatively: the magnitudes of floats have the
// order of their bits.
class Magnitudes {
 public:
  static constexpr int kShift = 12;  // from a magnitude's bits to its bin
  static constexpr size_t kBins = size_t(1) << (31 - kShift), kBytes = kBins * sizeof(uint64_t);

  static size_t binOf(float value) {
    return (std::bit_cast<uint32_t>(value) & 0x7fffffffu) >> kShift;
  }

  void add(std::span<const float> values) {
    for (const float value : values) ++counts_[binOf(value)];
  }
  void add(const Magnitudes& other);

  // The lowest bin that, with all bins above it, holds at most `share` of all numbers, but at least
  // one number.
  size_t leastBin(double share) const;

 private:
  std::vector<uint64_t> counts_ = std::vector<uint64_t>(kBins);
};

// Sets the numbers below this bin to 0. Returns the number of zeros.
uint64_t dropBelow(size_t leastBin, std::span<float> values);

// Sets all but the largest magnitudes to 0: about `share` of the values stay. Returns the share of
// zeros.
double keepLargest(std::span<float> values, double share);

}  // namespace chromeball

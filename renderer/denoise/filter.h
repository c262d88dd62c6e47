// SPDX-License-Identifier: Apache-2.0
// The cross filter: each half of a pixel's samples is filtered with weights from the other half, so
// that the weights are independent of the noise that they average (Rousselle et al. 2012).
#pragma once

#include <atomic>

#include "base/parallel.h"
#include "denoise/regression.h"

namespace chromeball {

using HalfPlanes = std::array<RgbPlanes, 2>;

// Noise so far below the value needs no filter. Both squared, and summed over channels.
inline bool isNegligible(float variance, float value) {
  constexpr float kNegligible = 0.002f;  // relative
  return variance <= kNegligible * kNegligible * value;
}

// Part of the light of an image.
struct Component {
  HalfPlanes halves;
  RgbPlanes variance;  // of the mean of both halves
  Plane wanted;        // 0: this pixel needs no filter
};

// The input of weights[h]: half h.
using HalfGuides = std::array<NoisyPlanes, 2>;

HalfGuides guidesOf(const Component& component);

using Scratch = PerThread<TileWeights>;

// The weighted means of the channels of each half, with weights from the other.
using HalfChannels = std::array<std::vector<Plane>, 2>;
// Pixels with negligible noise may stay as they are.
HalfChannels averageHalves(const HalfGuides& halves, Scratch& scratch,
                           const std::atomic<bool>& stop);

constexpr int kBandwidths = 2;

struct FilteredHalves {
  std::array<HalfPlanes, kBandwidths> regressions;
  HalfPlanes averages;  // weighted means, for what no feature explains, such as a dark reflection
};

// The regressions have the weights raised to powers[0] and powers[1] (addRegressions()), the
// averages to averagePower; without averages if that is 0. The result does not depend on the number
// of threads.
FilteredHalves filterHalves(const Component& component, const HalfGuides& guides,
                            const FeaturePlanes& features,
                            const std::array<int, kBandwidths>& powers, int averagePower,
                            Scratch& scratch, const std::atomic<bool>& stop);

// Limits pixels with so much light that a filter would turn them into bright spots.

// Limits a pixel of one half of the samples to the light of the 5 x 5 pixels around it in the other
// half: if the sum of its squared channels exceeds theirs, it is scaled down to their sum. Rare
// bright paths are then missing from the image; where they are frequent, both halves have them, and
// nothing changes. Returns an estimate of the squared bias of each channel: the product of the mean
// light that either half loses around a pixel. (The square of the loss of both would overestimate
// it: the rarer the paths, the more.)
Plane limitFireflies(HalfPlanes& halves);

}  // namespace chromeball

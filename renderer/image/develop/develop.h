// SPDX-License-Identifier: Apache-2.0
// Applies the optics of a camera to a linear image, before tone mapping (HDRI book, section 9.2.5).
#pragma once

#include <optional>

#include "image/develop/bloom.h"
#include "image/develop/lens.h"
#include "image/image.h"

namespace chromeball {

// Streaks: an image blurred along a line, as if the camera had turned during the exposure.

inline constexpr double kMaxMotion = 4096;

struct Motion {
  double length;  // pixels
  double angle;   // degrees, counter-clockwise from the right
};

// The mean along a segment with its middle in the pixel. Each step along the longer axis of the
// segment takes two pixels by linear interpolation, weighted by the segment's share of the step:
// exactly a box if the segment is horizontal or vertical. The image is mirrored at its borders
// (mirrored()), so that the sum of its pixels is kept; not in the corners, if the segment is
// neither horizontal nor vertical. Infinity and NaN spread.
Image blurMotion(const Image& image, const Motion& motion);

// All steps.

// The settings, in the order in which they are applied.
struct DevelopSettings {
  std::optional<float> clip;  // R, G and B at most this: an image of low dynamic range, to compare
  std::optional<ThinLens> lens;
  std::optional<Motion> motion;
  std::vector<WeightedGaussian> bloom;  // of weights that sum to 1
  bool glare = false;                   // spencerGlare()
  double vignette = 0;                  // strength, 0 to 1
  std::optional<Image> falloff;         // in place of `vignette`

  GaussianMethod method = GaussianMethod::Fast;

  bool isEmpty() const {
    return !clip && !lens && !motion && bloom.empty() && !glare && vignette == 0 && !falloff;
  }
  bool needsFov() const { return lens || glare || vignette > 0; }
};

struct DevelopReport {
  size_t invalid = 0;  // pixels with NaN or infinity that no clip has made finite; they are 0
  size_t limited = 0;  // pixels whose radius of confusion is kMaxConfusionRadius
};

// Develops an image with channels R, G, B and possibly alpha; the colour is premultiplied by alpha,
// and alpha is blurred with it. `depth` is for `lens` and else ignored. Needs the memory of at most
// three more images; the depth blur needs 12 bytes per pixel more.
DevelopReport develop(Image& image, const DevelopSettings& settings, const Image* depth,
                      const ViewFrame& frame);

}  // namespace chromeball

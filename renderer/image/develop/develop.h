// SPDX-License-Identifier: Apache-2.0
// Applies the optics of a camera to a linear image, before tone mapping (HDRI book, section 9.2.5).
#pragma once

#include <optional>

#include "image/develop/bloom.h"
#include "image/develop/lens.h"
#include "image/develop/motion_blur.h"

namespace chromeball {

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

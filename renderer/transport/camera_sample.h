// SPDX-License-Identifier: Apache-2.0
// Camera rays, one at a time; see camera_samples.h for many.
#pragma once

#include <optional>
#include <span>

#include "transport/path.h"

namespace chromeball {

// The pixel (x, y) of samples that share a randomisation of the sampler's table. `half`: which half
// of the pixel's samples (Film) they belong to.
struct CameraPixel {
  int x = 0, y = 0, half = 0;
  PixelNumbers numbers;
  Beam beam{};  // the footprint of each ray, for texture filtering
};

// A ray through a pixel, which must outlive it, and its closest hit.
struct CameraSample {
  const CameraPixel* pixel = nullptr;
  PixelSampler::Sample numbers{};
  Ray ray{};
  std::optional<Hit> hit{};
  float widening = 0;         // as in PathState
  FirstHit* first = nullptr;  // output; null: not wanted
  std::span<Rgb> layers{};    // output: one value per layer of Integrator::layers(), initially 0

  void start(PixelSampler& sampler) const { sampler.startSample(numbers); }
  PathState path() const {
    return {.ray = ray, .widening = widening, .beam = pixel->beam, .first = first};
  }
};

}  // namespace chromeball

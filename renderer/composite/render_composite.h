// SPDX-License-Identifier: Apache-2.0
// Renders what a composite is made of.
#pragma once

#include "composite/differential.h"
#include "integrate/render.h"

namespace chromeball {

enum class Passes {
  One,  // both worlds along the same paths (differential_path.h)
  Two,  // two plain renders with seeds of their own, subtracted: slow, noisy and obviously right
};

struct CompositeRender {
  RenderResult result;  // of the one pass, or of the one with objects
  DifferentialFilm film;
  Image mean;          // the composite by the difference formula
  PixelErrors errors;  // of the mean
};

// `accel` holds the whole scene; the plate is of the picture's size. `looksBehind`: L_noobj is
// wanted also where an object hides it.
CompositeRender renderComposite(const Scene& scene, const Accel& accel, const ObjectMask& isObject,
                                const Camera& camera, const LightingStrategy& lighting,
                                const Image& plate, const RenderSettings& settings, Passes passes,
                                bool looksBehind, const Progress& progress,
                                const std::atomic<bool>& stop);

}  // namespace chromeball

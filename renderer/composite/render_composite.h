// SPDX-License-Identifier: Apache-2.0
// Renders what a composite is made of.
#pragma once

#include "composite/differential.h"
#include "integrate/render.h"

namespace chromeball {

enum class Passes {
  One,  // both worlds along shared paths (differential.h)
  Two,  // two plain renders with seeds of their own, subtracted: the slow reference
};

struct CompositeRender {
  RenderResult result;  // of the one pass, or of the one with objects
  DifferentialFilm film;
  Image mean;          // the composite by the difference formula
  PixelErrors errors;  // of the mean
};

// `world` has the masks of composite/objects.h; the plate is of the picture's size.
// `behindObjects`: L_noobj is wanted also where an object hides it.
CompositeRender renderComposite(const World& world, const Camera& camera,
                                const LightingStrategy& lighting, const Image& plate,
                                const RenderSettings& settings, Passes passes, bool behindObjects,
                                const Progress& progress, const std::atomic<bool>& stop);

// Memory that a composite takes beside a plain render.
inline size_t compositeBytesPerPixel() {
  constexpr size_t kImages = 60;  // plate, mean, variance, ...
  return LayerFilm::bytesPerPixel(DifferentialFilm::kLayers) + kImages;
}

}  // namespace chromeball

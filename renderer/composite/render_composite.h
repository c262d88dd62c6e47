// SPDX-License-Identifier: Apache-2.0
// Renders the layers of a composite.
#pragma once

#include "composite/differential.h"
#include "composite/layers.h"
#include "render/render.h"

namespace chromeball {

struct CompositeRender {
  RenderResult result;  // of the only pass, or of the pass with objects
  Image mean;           // the composite by the difference formula (compose.h)
  PixelErrors errors;   // of the mean

  DifferentialFilm film() const { return DifferentialFilm(result.layers); }
};

// `world` must have the masks of composite/differential.h, and the plate the size of the image; if
// it is empty, in one pass, the mean is the radiance with the objects. `behindObjects`: also
// estimate L_noobj where an object hides it. `control`: for one pass; may be null. Limits hold for
// both passes together; a pixel that one of them did not reach before it was stopped has no
// samples.
CompositeRender renderComposite(const World& world, const Camera& camera,
                                const LightSource& lighting, const Image& plate,
                                const RenderSettings& settings, Passes passes, bool behindObjects,
                                const Progress& progress, const std::atomic<bool>& stop,
                                RenderControl* control = nullptr);

// Memory of a composite in addition to that of a plain render.
inline size_t compositeBytesPerPixel(bool denoises) {
  constexpr size_t kImages = 60;  // plate, mean, variance, ...
  const auto film = [](bool inHalves) {
    return LayerFilm::bytesPerPixel(DifferentialFilm::kLayers, inHalves);
  };
  return film(false) + (denoises ? film(true) : 0) + kImages;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "session/viewer.h"

#include <algorithm>

namespace chromeball {

ImageSoFar imageSoFar(FinishedImage finished, const RenderResult& render) {
  std::vector<Layer>& layers = finished.image.layers;
  const auto has = [&](const char* name) {
    return std::ranges::any_of(layers, [&](const Layer& layer) { return layer.name == name; });
  };
  if (!has("variance")) layers.push_back({"variance", "RGB", std::move(finished.noise.variance)});
  if (!has("samples")) layers.push_back({"samples", "", render.film.sampleCounts()});
  return {std::move(finished.image), render.samples, finished.noise.noise};
}

}  // namespace chromeball

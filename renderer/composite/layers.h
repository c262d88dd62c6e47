// SPDX-License-Identifier: Apache-2.0
// The layers that composites have beside those of plain renders (film/aov.h).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "composite/differential_film.h"
#include "image/image.h"

namespace chromeball {

enum class CompositeLayer {
  WithObjects,     // l_obj: radiance with the objects
  WithoutObjects,  // l_noobj: radiance without them
  Difference,      // (1 - alpha) (L_obj - L_noobj)
  Alpha,           // fraction of the pixel that objects cover
  Reflectance,     // of the local scene
};

struct CompositeLayerInfo {
  CompositeLayer layer;
  const char* name;      // on the command line and in the EXR
  const char* channels;  // one letter each
};
const std::vector<CompositeLayerInfo>& compositeLayers();

// nullptr where the name is none of a composite's layers.
const CompositeLayerInfo* findCompositeLayer(std::string_view name);

// The image of a layer; not of Reflectance, which is a Projection's.
Image compositeLayer(const DifferentialFilm& film, CompositeLayer layer);

}  // namespace chromeball

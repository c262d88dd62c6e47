// SPDX-License-Identifier: Apache-2.0
// Additional layers of composites, besides those of film/aov.h.
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
  Ratio,           // L_obj / L_noobj of the samples that see no object; 1 where L_noobj is 0
  Objects,         // alpha L_objects: radiance of the objects, premultiplied
  Alpha,           // fraction of the pixel that objects cover
  Reflectance,     // of the local scene
};

struct CompositeLayerInfo {
  CompositeLayer layer;
  const char* name;      // on the command line and in the EXR
  const char* channels;  // one letter each
};
const std::vector<CompositeLayerInfo>& compositeLayers();

// nullptr for an unknown name.
const CompositeLayerInfo* findCompositeLayer(std::string_view name);

// The image of a layer; not for Reflectance, which is in Projection::colors().
Image compositeLayer(const DifferentialFilm& film, CompositeLayer layer);

}  // namespace chromeball

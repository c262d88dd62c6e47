// SPDX-License-Identifier: Apache-2.0
// Additional layers of composites, besides the layers of film/aov.h.
#pragma once

#include <string_view>
#include <vector>

#include "film/layer_film.h"
#include "image/image.h"

namespace chromeball {

// The accumulated layers from which a composite is computed.

// Sums over the samples of a pixel.
struct DifferentialPixel {
  double count = 0, covered = 0;  // all samples; samples that see an object first (covered)
  glm::dvec3 objects{0};          // L_obj of the covered samples
  glm::dvec3 behind{0};           // L_noobj of the covered samples, if requested
  glm::dvec3 local{0};            // L_noobj of the other samples
  glm::dvec3 difference{0};  // L_obj - L_noobj of the other samples; exactly 0 without any effect

  // L_obj / L_noobj of the other samples; 1 where L_noobj is 0.
  glm::dvec3 ratio() const {
    glm::dvec3 ratio(1);
    for (int c = 0; c < 3; ++c)
      if (local[c] > 0) ratio[c] = (local[c] + difference[c]) / local[c];
    return ratio;
  }
};

// A view of an integrator's layers.
class DifferentialFilm {
 public:
  enum Layer { kCoverage, kObjects, kBehind, kLocal, kDifference, kLayers };

  static std::vector<Accumulation> layers() {
    return std::vector<Accumulation>(kLayers, Accumulation::Sum);
  }

  explicit DifferentialFilm(const LayerFilm& film) : film_(&film) {}  // must outlive this
  explicit DifferentialFilm(LayerFilm&&) = delete;

  HalvedImage mean(Layer layer) const { return film_->mean(layer); }  // film in halves

  int width() const { return film_->width(); }
  int height() const { return film_->height(); }

  DifferentialPixel at(int x, int y) const {
    return {double(film_->count(x, y)),   film_->value(x, y, kCoverage).x,
            film_->value(x, y, kObjects), film_->value(x, y, kBehind),
            film_->value(x, y, kLocal),   film_->value(x, y, kDifference)};
  }

 private:
  const LayerFilm* film_;
};

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

// How a composite is made.

enum class CompositeMode { Difference, Ratio, ShadowCatcher };  // compose.h

enum class Passes {
  One,  // both worlds along shared paths (differential.h)
  Two,  // two independent renders, subtracted: slow, as a reference
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The layers that a composite is made of.
#pragma once

#include "film/layer_film.h"

namespace chromeball {

// Sums over the samples of a pixel. `covered` of `count` samples saw an object first.
struct DifferentialPixel {
  double count = 0, covered = 0;
  glm::dvec3 objects{0};     // L_obj where an object is seen
  glm::dvec3 behind{0};      // L_noobj there, if it was wanted
  glm::dvec3 local{0};       // L_noobj elsewhere
  glm::dvec3 difference{0};  // L_obj - L_noobj elsewhere; exactly 0 where objects change nothing
};

class DifferentialFilm {
 public:
  enum Layer { kCoverage, kObjects, kBehind, kLocal, kDifference, kLayers };

  static std::vector<Accumulation> layers() {
    return std::vector<Accumulation>(kLayers, Accumulation::Sum);
  }

  explicit DifferentialFilm(LayerFilm film) : film_(std::move(film)) {}

  int width() const { return film_.width(); }
  int height() const { return film_.height(); }

  DifferentialPixel at(int x, int y) const {
    return {double(film_.count(x, y)),   film_.value(x, y, kCoverage).x,
            film_.value(x, y, kObjects), film_.value(x, y, kBehind),
            film_.value(x, y, kLocal),   film_.value(x, y, kDifference)};
  }

 private:
  LayerFilm film_;
};

}  // namespace chromeball

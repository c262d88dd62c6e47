// SPDX-License-Identifier: Apache-2.0
// The integrator of a composite: what the objects look like, and what they change of the plate.
#pragma once

#include "composite/differential_path.h"

namespace chromeball {

// What the samples of a pixel found. `covered` of `count` samples saw an object first.
struct DifferentialPixel {
  uint32_t count = 0, covered = 0;
  glm::dvec3 objects{0};  // sum of L_obj where an object is seen
  glm::dvec3 behind{0};   // sum of L_noobj there, where that was asked for
  glm::dvec3 local{0};    // sum of L_noobj elsewhere
  // Sum of L_obj - L_noobj elsewhere; exactly 0 where objects change nothing.
  glm::dvec3 difference{0};
};

// An image of such pixels.
struct DifferentialFilm {
  int width = 0, height = 0;
  std::vector<DifferentialPixel> pixels;

  DifferentialFilm(int w, int h) : width(w), height(h), pixels(size_t(w) * h) {}
  DifferentialPixel& at(int x, int y) { return pixels[size_t(y) * width + x]; }
  const DifferentialPixel& at(int x, int y) const { return pixels[size_t(y) * width + x]; }
};

// A sample's radiance is that of the composite by the difference formula: the object's where the
// camera sees one, else plate + L_obj - L_noobj, which may be negative. A limit (clamp.h) applies
// to objects and differences, never to the plate.
class DifferentialIntegrator : public Integrator {
 public:
  // All of them must outlive this; `film` is of the plate's size.
  DifferentialIntegrator(const DifferentialScene& scene, const Image& plate, DifferentialFilm& film)
      : scene_(scene), plate_(plate), film_(film) {}

  Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit* first) const override;

 private:
  const DifferentialScene& scene_;
  const Image& plate_;
  DifferentialFilm& film_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Differential rendering (HDRI book, 9.7.1) in one pass: radiance with the synthetic objects and
// without them, along paths that are shared until an object matters.
#pragma once

#include "composite/differential_film.h"
#include "composite/worlds.h"
#include "image/image.h"
#include "integrate/integrator.h"

namespace chromeball {

struct DifferentialSample {
  Rgb both{0};                     // found with the objects and without them
  Rgb withObjects{0}, without{0};  // found only so
  bool objectFirst = false;        // the camera sees an object

  Rgb difference() const { return withObjects - without; }
};

// `camera.hit` is that of the whole scene. Random numbers are the same in both worlds, and
// everything before an object is met or shades something is computed once, so that `difference()`
// is exactly 0 where objects change nothing. `behindObjects`: L_noobj is wanted also where the
// camera sees an object.
DifferentialSample differentialRadiance(const CompositeWorlds& worlds, const CameraSample& camera,
                                        bool behindObjects, PathContext& context);

// A sample's radiance is that of the composite by the difference formula: the object's where the
// camera sees one, else plate + L_obj - L_noobj, which may be negative. A clamp applies to objects
// and differences, never to the plate. Fills the layers of DifferentialFilm.
class DifferentialIntegrator : public Integrator {
 public:
  // All must outlive this; the plate is of the picture's size.
  DifferentialIntegrator(const CompositeWorlds& worlds, const Image& plate, bool behindObjects)
      : worlds_(worlds), plate_(plate), behindObjects_(behindObjects) {}

  Sample sample(const CameraSample& camera, PathContext& context) const override;
  std::vector<Accumulation> layers() const override { return DifferentialFilm::layers(); }

 private:
  const CompositeWorlds& worlds_;
  const Image& plate_;
  bool behindObjects_;
};

}  // namespace chromeball

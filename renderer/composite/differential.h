// SPDX-License-Identifier: Apache-2.0
// Differential rendering (HDRI book, section 9.7.1) in one pass: radiance with and without the
// synthetic objects, along paths that are shared until an object affects them.
#pragma once

#include <vector>

#include "composite/layers.h"
#include "image/image.h"
#include "trace/ray.h"
#include "transport/integrator.h"
#include "transport/path.h"

namespace chromeball {

// Ray masks of the two worlds of a composite: with and without the synthetic objects.

// For each instance: true for a synthetic object, false for the local scene (a model of real
// surfaces in the plate).
using ObjectMask = std::vector<bool>;

// Rays with kLocalScene hit only the local scene; rays with kAllInstances also hit the objects.
inline constexpr RayMask kLocalScene = 1, kObjects = 2;

// The masks for the World of a composite.
inline std::vector<RayMask> rayMasks(const ObjectMask& isObject) {
  std::vector<RayMask> masks;
  for (const bool object : isObject) masks.push_back(object ? kObjects : kLocalScene);
  return masks;
}

// Path tracers of both worlds of a composite. The camera does not see the probe, because the plate
// is the background.
struct CompositeWorlds {
  // `world` must have the masks of rayMasks(); it and `lighting` must outlive this.
  CompositeWorlds(const World& world, const LightSource& lighting, PathSettings settings)
      : whole(world, lighting, with(settings, kAllInstances, kAllInstances)),
        local(world, lighting, with(settings, kLocalScene, kLocalScene)),
        shared(world, lighting, with(settings, kAllInstances, kLocalScene)) {}

  bool isObject(const Hit& hit) const { return whole.world().accel.mask(hit.instance) == kObjects; }

  PathTracer whole, local;
  PathTracer shared;  // as `whole`, and compares shadow rays with `local`

 private:
  static PathSettings with(PathSettings settings, RayMask visible, RayMask compared) {
    settings.hideProbe = true;
    settings.visible = visible;
    settings.compared = compared;
    settings.estimateDepthCut = visible == kAllInstances;  // only for the world with objects
    return settings;
  }
};

struct DifferentialSample {
  Rgb both{0};                     // radiance common to both worlds
  Rgb withObjects{0}, without{0};  // further radiance with the objects, and without them
  bool objectFirst = false;        // the camera ray hits an object first

  Rgb difference() const { return withObjects - without; }
};

// The samples of camera rays, whose hits are those in the scene with objects. Both worlds use the
// same random numbers, and vertices are computed once up to the first one that an object affects
// (by a hit or by a shadow ray), so that `difference()` is exactly 0 where objects have no effect;
// from there on, the paths of all samples are traced together. `behindObjects`: also estimate
// L_noobj where the camera sees an object. `samples`: output, as many as cameras, at most
// PathBatch::kMaxPaths.
void differentialRadiance(const CompositeWorlds& worlds, const CameraSamples& cameras,
                          bool behindObjects, PathContext& context,
                          std::span<DifferentialSample> samples);

// Samples of the composite by the difference formula: the radiance of an object where the camera
// sees one, otherwise plate + L_obj - L_noobj, which may be negative. The clamp applies to objects
// and differences, not to the plate. Writes the layers of DifferentialFilm.
class DifferentialIntegrator : public Integrator {
 public:
  // All arguments must outlive this. The plate has the size of the image, or is empty: then samples
  // are the radiance with the objects.
  DifferentialIntegrator(const CompositeWorlds& worlds, const Image& plate, bool behindObjects)
      : worlds_(worlds), plate_(plate), behindObjects_(behindObjects) {}

  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const override;
  std::vector<Accumulation> layers() const override { return DifferentialFilm::layers(); }

 private:
  Sample composed(const DifferentialSample& found, const CameraSample& camera,
                  PathContext& context) const;

  const CompositeWorlds& worlds_;
  const Image& plate_;
  bool behindObjects_;
};

}  // namespace chromeball

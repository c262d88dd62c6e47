// SPDX-License-Identifier: Apache-2.0
#include "composite/render_composite.h"

#include "integrate/surface_layers.h"

namespace chromeball {
namespace {

// Renders one of the two worlds. The sum of both renders is the composite: with objects the samples
// are L_objects or plate + L_obj, without objects -L_noobj (0 where an object is visible).
class OneWorld : public Integrator {
 public:
  OneWorld(const CompositeWorlds& worlds, bool withObjects, const Image& plate, bool behindObjects)
      : worlds_(worlds), withObjects_(withObjects), plate_(plate), behindObjects_(behindObjects) {}

  std::vector<Accumulation> layers() const override { return DifferentialFilm::layers(); }

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    context.sampler.startVertex(0);
    PathState start = camera.path();
    const auto hit = worlds_.whole.skipHiddenBacks(start, camera.hit, context);
    const bool objectFirst = hit && worlds_.isObject(*hit);
    std::vector<Rgb>& layers = context.layers;
    if (withObjects_) {
      const Rgb found = worlds_.whole.radiance(start, hit, context);
      layers[DifferentialFilm::kCoverage] = Rgb(objectFirst);
      layers[objectFirst ? DifferentialFilm::kObjects : DifferentialFilm::kDifference] = found;
      if (objectFirst) return found;
      return {plate_.rgb(camera.x, camera.y) + found, defectOf(found, false)};
    }
    if (objectFirst && !behindObjects_) return Rgb(0);
    start = camera.path();
    const Rgb found =
        worlds_.local.radiance(start, worlds_.local.closestHit(start.ray, context), context);
    layers[objectFirst ? DifferentialFilm::kBehind : DifferentialFilm::kLocal] = found;
    if (objectFirst) return {Rgb(0), defectOf(found, false)};
    layers[DifferentialFilm::kDifference] = -found;
    return {-found, defectOf(found, false)};
  }

 private:
  const CompositeWorlds& worlds_;
  bool withObjects_;
  const Image& plate_;
  bool behindObjects_;
};

Image sum(Image a, const Image& b) {
  for (size_t i = 0; i < a.texels.size(); ++i) a.texels[i] += b.texels[i];
  return a;
}

}  // namespace

CompositeRender renderComposite(const World& world, const Camera& camera,
                                const LightSource& lighting, const Image& plate,
                                const RenderSettings& settings, Passes passes, bool behindObjects,
                                const Progress& progress, const std::atomic<bool>& stop,
                                RenderControl* control) {
  if (passes == Passes::One) {
    GuideTraining training(world, lighting, settings, GuideTraining::Guides::Bounces);
    const CompositeWorlds worlds(world, lighting, training.guided(settings.path()));
    const DifferentialIntegrator picture(worlds, plate, behindObjects);
    const SurfaceLayers layers(picture, worlds.whole, settings);
    const Integrator& integrator =
        settings.wantsSurfaceLayers() ? layers : static_cast<const Integrator&>(picture);
    RenderResult result =
        render(integrator, world, camera, settings, progress, stop, &training, control);
    Image mean = result.film.mean();
    PixelErrors errors = result.film.errors();
    return {std::move(result), std::move(mean), std::move(errors)};
  }

  const CompositeWorlds worlds(world, lighting, settings.path());
  RenderResult result = render(
      OneWorld(worlds, true, plate, behindObjects), world, camera, settings,
      [&](double fraction) { progress(fraction / 2); }, stop);
  Image mean = result.film.mean();
  PixelErrors errors = result.film.errors();
  if (result.samples == 0) return {std::move(result), std::move(mean), std::move(errors)};
  RenderSettings second = settings;
  second.seed = hash(settings.seed, 1);
  second.samples = result.samples;  // a limit may have ended the first pass early
  second.timeLimit.reset();
  second.noiseLimit.reset();
  const RenderResult without = render(
      OneWorld(worlds, false, plate, behindObjects), world, camera, second,
      [&](double fraction) { progress((1 + fraction) / 2); }, stop);
  result.samples = std::min(result.samples, without.samples);
  result.rays.add(without.rays);
  result.interrupted |= without.interrupted;
  result.invalid.add(without.invalid);
  result.layers.addValues(without.layers);
  errors.add(without.film.errors());
  mean = sum(std::move(mean), without.film.mean());
  return {std::move(result), std::move(mean), std::move(errors)};
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "composite/render_composite.h"

#include <algorithm>
#include <cmath>

#include "approximate/occlusion.h"

namespace chromeball {
namespace {

// Renders one of the two worlds. The sum of both renders is the composite: with objects the samples
// are L_objects or plate + L_obj, without objects -L_noobj (0 where an object is visible).
class OneWorld : public SingleIntegrator {
 public:
  OneWorld(const CompositeWorlds& worlds, bool withObjects, const Image& plate, bool behindObjects)
      : worlds_(worlds), withObjects_(withObjects), plate_(plate), behindObjects_(behindObjects) {}

  std::vector<Accumulation> layers() const override { return DifferentialFilm::layers(); }

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    context.sampler.startVertex(0);
    PathState start = camera.path();
    const auto hit = worlds_.whole.skipHiddenBacks(start, camera.hit, context);
    const bool objectFirst = hit && worlds_.isObject(*hit);
    const std::span<Rgb> layers = camera.layers;
    if (withObjects_) {
      const Rgb found = worlds_.whole.radiance(start, hit, context);
      layers[DifferentialFilm::kCoverage] = Rgb(objectFirst);
      layers[objectFirst ? DifferentialFilm::kObjects : DifferentialFilm::kDifference] = found;
      if (objectFirst) return found;
      return {plate_.rgb(camera.pixel->x, camera.pixel->y) + found, defectOf(found, false)};
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

// Renders the picture, with the layers of SurfaceLayers if they are wanted.
RenderResult renderPicture(const Integrator& picture, const PathTracer& tracer,
                           const Camera& camera, const RenderSettings& settings,
                           const Progress& progress, const std::atomic<bool>& stop,
                           GuideTraining* training = nullptr, RenderControl* control = nullptr) {
  const World& world = tracer.world();
  if (!settings.wantsSurfaceLayers())
    return render(picture, world, camera, settings, progress, stop, training, control);
  return render(SurfaceLayers(picture, tracer, settings.aovs, settings.occlusion), world, camera,
                settings, progress, stop, training, control);
}

// Each pass gets half of the time, and half of the squared noise.
RenderSettings firstPass(RenderSettings settings) {
  if (settings.timeLimit) *settings.timeLimit /= 2;
  if (settings.noiseLimit) *settings.noiseLimit /= std::sqrt(2.0);
  return settings;
}

// The settings of the second pass: as many samples as the first took before a limit ended it, and
// other random numbers.
RenderSettings secondPass(RenderSettings settings, uint32_t samples) {
  settings.seed = hash(settings.seed, 1);
  settings.samples = std::max(samples, 1u);  // none if the first pass was stopped at once
  settings.timeLimit.reset();
  settings.noiseLimit.reset();
  return settings;
}

CompositeRender renderTwice(const CompositeWorlds& worlds, const Camera& camera, const Image& plate,
                            const RenderSettings& settings, bool behindObjects,
                            const Progress& progress, const std::atomic<bool>& stop) {
  const RenderSettings first = firstPass(settings);
  RenderResult result = renderPicture(
      OneWorld(worlds, true, plate, behindObjects), worlds.whole, camera, first,
      [&](double fraction) { progress(fraction / 2); }, stop);
  Image mean = result.film.mean();
  PixelErrors errors = result.film.errors();
  const RenderSettings second = secondPass(settings, result.samples);
  const RenderResult without = render(
      OneWorld(worlds, false, plate, behindObjects), worlds.local.world(), camera, second,
      [&](double fraction) { progress((1 + fraction) / 2); }, stop);
  result.samples = std::min(result.samples, without.samples);
  result.rays.add(without.rays);
  result.interrupted |= without.interrupted;
  result.invalid.add(without.invalid);
  result.layers.addMeans(without.layers);  // the passes may differ in a pixel's number of samples
  errors.add(without.film.errors());
  mean = sum(std::move(mean), without.film.mean());
  return {std::move(result), std::move(mean), std::move(errors)};
}

}  // namespace

CompositeRender renderComposite(const World& world, const Camera& camera,
                                const LightSource& lighting, const Image& plate,
                                const RenderSettings& settings, Passes passes, bool behindObjects,
                                const Progress& progress, const std::atomic<bool>& stop,
                                RenderControl* control) {
  if (passes == Passes::One) {
    GuideTraining training(world, lighting, settings);
    const CompositeWorlds worlds(world, lighting, training.guided(settings.path()));
    const DifferentialIntegrator picture(worlds, plate, behindObjects);
    RenderResult result =
        renderPicture(picture, worlds.whole, camera, settings, progress, stop, &training, control);
    Image mean = result.film.mean();
    PixelErrors errors = result.film.errors();
    return {std::move(result), std::move(mean), std::move(errors)};
  }

  return renderTwice(CompositeWorlds(world, lighting, settings.path()), camera, plate, settings,
                     behindObjects, progress, stop);
}

}  // namespace chromeball

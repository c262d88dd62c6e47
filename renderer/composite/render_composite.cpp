// SPDX-License-Identifier: Apache-2.0
#include "composite/render_composite.h"

namespace chromeball {
namespace {

// One of the two worlds on its own. The sum of a pixel's samples is the composite's part: with
// objects, theirs or plate + L_obj; without, L_noobj where no object is seen.
class OneWorld : public Integrator {
 public:
  OneWorld(const DifferentialScene& scene, bool withObjects, const Image& plate,
           DifferentialFilm& film)
      : scene_(scene), withObjects_(withObjects), plate_(plate), film_(film) {}

  Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit* first) const override {
    memory.sampler.startVertex(0);
    PathState start = camera.path();
    const auto hit =
        passUnseen(scene_.whole.scene, scene_.whole.rays, start, camera.hit, memory.sampler);
    const bool objectFirst = hit && scene_.isObject[hit->instance];
    DifferentialPixel& pixel = film_.at(camera.x, camera.y);
    if (withObjects_) {
      const Rgb found = trace(scene_.whole, start, hit, memory, first);
      if (const auto defect = defectOf(found, false)) return {found, defect};
      ++pixel.count;
      pixel.covered += objectFirst;
      (objectFirst ? pixel.objects : pixel.difference) += glm::dvec3(found);
      if (objectFirst) return found;
      return {plate_.rgb(camera.x, camera.y) + found, std::nullopt};
    }
    if (objectFirst && !scene_.looksBehind) return Rgb(0);
    start = camera.path();
    const Rgb found =
        trace(scene_.local, start, closestHit(scene_.local.rays, start.ray, memory.sampler), memory,
              first);
    if (const auto defect = defectOf(found, false)) return {found, defect};
    (objectFirst ? pixel.behind : pixel.local) += glm::dvec3(found);
    if (objectFirst) return Rgb(0);
    pixel.difference -= glm::dvec3(found);
    return found;
  }

 private:
  template <class Rays>
  static Rgb trace(const PathScene<Rays>& path, const PathState& start,
                   const std::optional<Hit>& hit, PathMemory& memory, FirstHit* first) {
    return pathRadiance(path, start, hit, memory.sampler, memory.samples, memory.rays, first);
  }

  const DifferentialScene& scene_;
  bool withObjects_;
  const Image& plate_;
  DifferentialFilm& film_;
};

Image difference(Image a, const Image& b) {
  for (size_t i = 0; i < a.texels.size(); ++i) a.texels[i] -= b.texels[i];
  return a;
}

}  // namespace

CompositeRender renderComposite(const Scene& scene, const Accel& accel, const ObjectMask& isObject,
                                const Camera& camera, const LightingStrategy& lighting,
                                const Image& plate, const RenderSettings& settings, Passes passes,
                                bool looksBehind, const Progress& progress,
                                const std::atomic<bool>& stop) {
  ObjectMask isLocal = isObject;
  isLocal.flip();
  const Accel localAccel(scene, isLocal);
  const LocalRays localRays{localAccel, isObject};
  const std::unique_ptr<Emitters> emitters = Emitters::make(scene);
  const std::unique_ptr<PunctualLights> punctual = PunctualLights::make(scene);
  constexpr bool kHideProbe = true;  // the plate is the background
  DifferentialScene worlds{{scene, accel, lighting, emitters.get(), settings.mis, settings.maxDepth,
                            kHideProbe, punctual.get()},
                           {scene, localRays, lighting, emitters.get(), settings.mis,
                            settings.maxDepth, kHideProbe, punctual.get()},
                           isObject,
                           looksBehind};
  worlds.whole.maxTransmissionDepth = worlds.local.maxTransmissionDepth =
      settings.maxTransmissionDepth;
  worlds.local.measuresCut = false;  // of the light with objects
  prepareBsdfs(scene);

  DifferentialFilm film(settings.width, settings.height);
  if (passes == Passes::One) {
    RenderResult result = render(DifferentialIntegrator(worlds, plate, film), accel, camera,
                                 settings, progress, stop);
    Image mean = result.film.mean();
    PixelErrors errors = result.film.errors();
    return {std::move(result), std::move(film), std::move(mean), std::move(errors)};
  }

  RenderResult result = render(
      OneWorld(worlds, true, plate, film), accel, camera, settings,
      [&](double fraction) { progress(fraction / 2); }, stop);
  Image mean = result.film.mean();
  PixelErrors errors = result.film.errors();
  if (result.samples == 0) return {std::move(result), std::move(film), mean, errors};
  RenderSettings again = settings;
  again.seed = hash(settings.seed, 1);
  again.samples = result.samples;  // both the same, also where time or noise ended the first
  again.timeLimit.reset();
  again.noiseLimit.reset();
  const RenderResult without = render(
      OneWorld(worlds, false, plate, film), accel, camera, again,
      [&](double fraction) { progress((1 + fraction) / 2); }, stop);
  result.samples = std::min(result.samples, without.samples);
  result.rays.add(without.rays);
  result.interrupted |= without.interrupted;
  result.invalid.add(without.invalid);
  errors.add(without.film.errors());
  return {std::move(result), std::move(film), difference(mean, without.film.mean()),
          std::move(errors)};
}

}  // namespace chromeball

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

  Rgb radiance(const CameraSample& camera, PathMemory& memory, FirstHit* first) const override {
    const bool objectFirst = camera.hit && scene_.isObject[camera.hit->instance] &&
                             !isUnseen(scene_.whole.scene, PathState{camera.ray}, *camera.hit);
    DifferentialPixel& pixel = film_.at(camera.x, camera.y);
    if (withObjects_) {
      const Rgb found = trace(scene_.whole, camera.ray, camera.hit, memory, first);
      ++pixel.count;
      pixel.covered += objectFirst;
      (objectFirst ? pixel.objects : pixel.difference) += glm::dvec3(found);
      return objectFirst ? found : plate_.rgb(camera.x, camera.y) + found;
    }
    if (objectFirst && !scene_.looksBehind) return Rgb(0);
    memory.sampler.startVertex(0);
    const Rgb found =
        trace(scene_.local, camera.ray, closestHit(scene_.local.rays, camera.ray, memory.sampler),
              memory, first);
    (objectFirst ? pixel.behind : pixel.local) += glm::dvec3(found);
    if (objectFirst) return Rgb(0);
    pixel.difference -= glm::dvec3(found);
    return found;
  }
  bool isSigned() const override { return withObjects_; }  // a plate may be

 private:
  template <class Rays>
  static Rgb trace(const PathScene<Rays>& path, const Ray& ray, const std::optional<Hit>& hit,
                   PathMemory& memory, FirstHit* first) {
    return pathRadiance(path, ray, hit, memory.sampler, memory.samples, memory.rays, first);
  }

  const DifferentialScene& scene_;
  bool withObjects_;
  const Image& plate_;
  DifferentialFilm& film_;
};

Image combined(Image a, const Image& b, float sign) {
  for (size_t i = 0; i < a.texels.size(); ++i) a.texels[i] += sign * b.texels[i];
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
  const Beam beam = beamOf(scene, camera, settings);
  constexpr bool kHideProbe = true;  // the plate is the background
  const DifferentialScene worlds{{scene, accel, lighting, emitters.get(), settings.mis,
                                  settings.maxDepth, kHideProbe, punctual.get(), beam},
                                 {scene, localRays, lighting, emitters.get(), settings.mis,
                                  settings.maxDepth, kHideProbe, punctual.get(), beam},
                                 isObject,
                                 looksBehind};
  prepareBsdfs(scene);

  DifferentialFilm film(settings.width, settings.height);
  if (passes == Passes::One) {
    RenderResult result = render(DifferentialIntegrator(worlds, plate, film), accel, camera,
                                 settings, progress, stop);
    Image mean = result.film.mean(), variance = result.film.squaredStandardError();
    return {std::move(result), std::move(film), std::move(mean), std::move(variance)};
  }

  RenderResult result = render(
      OneWorld(worlds, true, plate, film), accel, camera, settings,
      [&](double share) { progress(share / 2); }, stop);
  RenderSettings again = settings;
  again.seed = hash(settings.seed, 1);
  again.samples = result.samples;  // both the same, also where time or noise ended the first
  again.timeLimit.reset();
  again.noiseLimit.reset();
  const RenderResult without = render(
      OneWorld(worlds, false, plate, film), accel, camera, again,
      [&](double share) { progress((1 + share) / 2); }, stop);
  result.rays.add(without.rays);
  result.interrupted |= without.interrupted;
  result.invalid.add(without.invalid);
  Image mean = combined(result.film.mean(), without.film.mean(), -1);
  Image variance =
      combined(result.film.squaredStandardError(), without.film.squaredStandardError(), 1);
  return {std::move(result), std::move(film), std::move(mean), std::move(variance)};
}

}  // namespace chromeball

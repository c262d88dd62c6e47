// SPDX-License-Identifier: Apache-2.0
#include "composite/reflectance.h"

#include "transport/first_surface.h"

namespace chromeball {
namespace {

constexpr Rgb kFirstEstimate(0.25f);         // typical of real surfaces
constexpr uint32_t kVisibilitySamples = 16;  // per pixel, to find the visible surfaces
constexpr uint32_t kMostSolveSamples = 1024;

PathSettings localSettings(const RenderSettings& settings) {
  PathSettings local = settings.path();
  local.hideProbe = true;
  local.estimateDepthCut = false;
  local.visible = local.compared = kLocalScene;
  return local;
}

// The visible surfaces of the local scene: per pixel the maximum depth, and the means of the
// model's base colour, of emitted radiance and of the fraction that is unlit; 0 where none is
// visible.
struct VisibleSurfaces {
  Image farthest, baseColor, emission, unlit;
};

class VisibilityIntegrator : public SingleIntegrator {
 public:
  enum Layer { kDepth, kCoverage, kBaseColor, kEmission, kUnlit };

  VisibilityIntegrator(const PathTracer& tracer, const CameraRays& camera)
      : tracer_(tracer), camera_(camera) {}

  std::vector<Accumulation> layers() const override {
    return {Accumulation::Maximum, Accumulation::Sum, Accumulation::Sum, Accumulation::Sum,
            Accumulation::Sum};
  }
  RayMask visible() const override { return kLocalScene; }

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    context.sampler.startVertex(0);
    PathState state = camera.path();
    const auto hit = tracer_.skipHiddenBacks(state, camera.hit, context);
    if (!hit) return Rgb(0);
    const Scene& scene = tracer_.world().scene;
    const vec3& direction = state.ray.direction;
    const Instance& instance = scene.instances[hit->instance];
    const Surface surface =
        surfaceAt(scene, instance, hit->triangle, hit->barycentric, -direction, 0, state.ray.time);
    const float distance = glm::length(surface.position - camera.ray.origin);
    camera.layers[kDepth] = Rgb(camera_.depth(direction, distance));
    camera.layers[kCoverage] = Rgb(1);
    camera.layers[kBaseColor] = materialAt(scene, surface).baseColor;
    if (surface.material->unlit)
      camera.layers[kUnlit] = Rgb(1);
    else if (surface.material->emits())
      camera.layers[kEmission] = emittedRadiance(scene, instance, surface, -direction);
    return Rgb(0);
  }

 private:
  const PathTracer& tracer_;
  const CameraRays& camera_;
};

// Radiance of the local scene with the base colour of the first visible surface replaced.
class RepaintedIntegrator : public SingleIntegrator {
 public:
  RepaintedIntegrator(const PathTracer& tracer, const Rgb& baseColor)
      : tracer_(tracer), baseColor_(baseColor) {}

  RayMask visible() const override { return kLocalScene; }

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    ++context.counts.camera;
    context.sampler.startVertex(0);
    PathState state = camera.path();
    auto first = firstSurface(tracer_, state, camera.hit, context);
    if (!first) return Rgb(0);
    if (first->surface.material->unlit) return baseColor_;
    if (first->surface.material->emits())
      state.radiance += tracer_.foundEmission(state, first->surface, first->hit);
    first->material.baseColor = baseColor_;
    return tracer_.reflected(state, first->surface, first->bsdf(tracer_, state), context);
  }

 private:
  const PathTracer& tracer_;
  Rgb baseColor_;
};

VisibleSurfaces findVisibleSurfaces(const ReflectanceProblem& problem,
                                    const RenderSettings& settings, const std::atomic<bool>& stop) {
  RenderSettings quick;
  quick.width = settings.width, quick.height = settings.height;
  quick.samples = kVisibilitySamples;
  quick.adaptive = false;
  quick.maxDepth = 0;
  quick.seed = settings.seed;
  const CameraRays camera(problem.camera, float(settings.width) / float(settings.height));
  const PathTracer tracer(problem.world, problem.lighting, localSettings(quick));
  const RenderResult result = render(
      VisibilityIntegrator(tracer, camera), problem.world, problem.camera, quick, [](double) {},
      stop);
  const auto image = [&](int channels) { return Image(settings.width, settings.height, channels); };
  VisibleSurfaces visible{image(1), image(3), image(3), image(1)};
  for (int y = 0; y < settings.height; ++y)
    for (int x = 0; x < settings.width; ++x) {
      const auto layer = [&](VisibilityIntegrator::Layer l) {
        return result.layers.value(x, y, l);
      };
      const double seen = layer(VisibilityIntegrator::kCoverage).x;
      if (seen == 0) continue;
      *visible.farthest.at(x, y) = float(layer(VisibilityIntegrator::kDepth).x);
      visible.baseColor.setRgb(x, y, Rgb(layer(VisibilityIntegrator::kBaseColor) / seen));
      visible.emission.setRgb(x, y, Rgb(layer(VisibilityIntegrator::kEmission) / seen));
      *visible.unlit.at(x, y) = float(layer(VisibilityIntegrator::kUnlit).x / seen);
    }
  return visible;
}

// Renders the visible local scene with the given base colour; the mean over the samples that hit
// it.
Image renderRepainted(const ReflectanceProblem& problem, const Rgb& baseColor,
                      const RenderSettings& settings, const Progress& progress,
                      const std::atomic<bool>& stop) {
  const PathTracer tracer(problem.world, problem.lighting, localSettings(settings));
  const RenderResult result = render(RepaintedIntegrator(tracer, baseColor), problem.world,
                                     problem.camera, settings, progress, stop);
  Image image = result.film.mean();
  const Image alpha = result.aovs.finished(Aov::Alpha);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (const float fraction = *alpha.at(x, y); fraction > 0)
        image.setRgb(x, y, image.rgb(x, y) / fraction);
  return image;
}

// One iteration, given the radiance with black and with white visible surfaces.
ReflectanceSolution solveStep(const Image& plate, const Image& black, const Image& white,
                              const VisibleSurfaces& visible, Projection& projection) {
  constexpr float kDark = 1e-4f;  // fraction of the mean below which a pixel counts as unlit
  ReflectanceSolution solution;
  double light = 0, plateSum = 0, modelSum = 0;
  const auto forVisible = [&](const auto& visit) {
    for (int y = 0; y < plate.height; ++y)
      for (int x = 0; x < plate.width; ++x)
        if (*visible.farthest.at(x, y) > 0) visit(x, y);
  };
  forVisible([&](int x, int y) {
    light += luminance(white.rgb(x, y) - black.rgb(x, y));
    ++solution.pixels;
  });
  if (solution.pixels == 0) return solution;
  const float dark = kDark * float(light / double(solution.pixels));
  forVisible([&](int x, int y) {
    const Rgb wanted = plate.rgb(x, y) - black.rgb(x, y);
    const Rgb received = white.rgb(x, y) - black.rgb(x, y), model = visible.baseColor.rgb(x, y);
    Rgb rho = model;
    for (int c = 0; c < 3; ++c)
      if (received[c] > dark) rho[c] = wanted[c] / received[c];
    solution.clamped += maxComponent(rho) > 1;
    // As a whole: the hue of a shadow is that of the light it blocks, and per channel the clamped
    // ones would darken less than the others.
    rho = glm::max(rho, 0.0f) / std::max(maxComponent(rho), 1.0f);
    solution.lastChange +=
        luminance(glm::abs(rho - projection.colors().rgb(x, y))) / double(solution.pixels);
    projection.colors().setRgb(x, y, rho);
    plateSum += luminance(plate.rgb(x, y));
    modelSum += luminance(black.rgb(x, y) + model * received);
  });
  solution.exposureRatio = modelSum > 0 ? plateSum / modelSum : 0;
  return solution;
}

void initialise(const VisibleSurfaces& visible, Projection& projection) {
  projection.setDepth(visible.farthest);
  Image& colors = projection.colors();
  for (int y = 0; y < colors.height; ++y)
    for (int x = 0; x < colors.width; ++x)
      colors.setRgb(x, y, *visible.farthest.at(x, y) > 0 ? kFirstEstimate : Rgb(0));
}

}  // namespace

ReflectanceSolution solveReflectance(const ReflectanceProblem& problem,
                                     const RenderSettings& settings, int iterations,
                                     Projection& projection, const Progress& progress,
                                     const std::atomic<bool>& stop) {
  const VisibleSurfaces visible = findVisibleSurfaces(problem, settings, stop);
  initialise(visible, projection);

  RenderSettings step = settings;
  step.aovs = {Aov::Alpha};
  step.samples = std::min(settings.samples, kMostSolveSamples);
  step.timeLimit.reset();
  step.noiseLimit.reset();
  step.adaptive = false;  // images with and without reflectance share their samples
  const Scene& scene = problem.world.scene;
  bool blackIsLit = false;  // whether a black base colour has radiance: emission or a highlight
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Material& m = scene.materials[size_t(scene.instances[i].material)];
    blackIsLit |=
        problem.world.accel.mask(i) == kLocalScene && (m.emits() || m.specular > 0 || m.extended);
  }

  ReflectanceSolution solution;
  for (int i = 0; i < iterations && !stop; ++i) {
    const auto report = [&](double fraction) { progress((i + fraction) / iterations); };
    Image black(settings.width, settings.height, 3);
    if (blackIsLit) black = renderRepainted(problem, Rgb(0), step, report, stop);
    const Image white = renderRepainted(problem, Rgb(1), step, report, stop);
    solution = solveStep(problem.plate, black, white, visible, projection);
  }
  return solution;
}

ReflectanceSolution solveFlatReflectance(const ReflectanceProblem& problem,
                                         const RenderSettings& settings, const Rgb& irradiance,
                                         Projection& projection, const std::atomic<bool>& stop) {
  const VisibleSurfaces visible = findVisibleSurfaces(problem, settings, stop);
  initialise(visible, projection);
  const Image& black = visible.emission;
  const Image white = colorImage(settings.width, settings.height, [&](int x, int y) {
    return black.rgb(x, y) + glm::mix(irradiance * kInvPi, Rgb(1), *visible.unlit.at(x, y));
  });
  return solveStep(problem.plate, black, white, visible, projection);
}

}  // namespace chromeball

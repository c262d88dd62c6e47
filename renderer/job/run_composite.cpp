// SPDX-License-Identifier: Apache-2.0
#include "job/run_composite.h"

#include <algorithm>

#include "composite/denoise_composite.h"
#include "composite/layers.h"
#include "composite/local_scene.h"
#include "composite/reflectance.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

// Irradiance of the flat local scene.
Rgb flatIrradiance(const LoadedScene& loaded) {
  const glm::quat back =
      glm::angleAxis(-glm::radians(loaded.probe.rotationDegrees()), vec3(0, 1, 0));
  const vec3 normal = back * *flatNormal(loaded.scene, loaded.isObject);
  return Rgb(exactIrradiance(loaded.probe.latLong(), {&normal, 1})[0]);
}

// Fills loaded.projection with the local scene's reflectance.
CompositeReport::Reflectance solveReflectance(const RenderJob& job, const LoadedScene& loaded,
                                              const PreparedScene& prepared,
                                              const Progress& progress,
                                              const std::atomic<bool>& stop) {
  const ReflectanceProblem problem{*prepared.world, loaded.camera, *prepared.lighting,
                                   job.composite->plate};
  RenderSettings settings = job.settings;
  settings.denoise = false;  // only the composite is denoised
  const ReflectanceSolution solution =
      job.composite->reflectance == CompositePlan::Reflectance::Flat
          ? solveFlatReflectance(problem, settings, flatIrradiance(loaded), *loaded.projection,
                                 stop)
          : solveReflectance(problem, settings, job.composite->iterations, *loaded.projection,
                             progress, stop);
  const double clamped = double(solution.clamped) / double(std::max<size_t>(solution.pixels, 1));
  return {solution.pixels, clamped, solution.exposureRatio, solution.lastChange};
}

Layer layerOf(const std::string& name, const LoadedScene& loaded, const CompositeRender& render,
              const Image& variance) {
  if (const CompositeLayerInfo* own = findCompositeLayer(name))
    return {own->name, own->channels,
            own->layer == CompositeLayer::Reflectance ? loaded.projection->colors()
                                                      : compositeLayer(render.film, own->layer)};
  const Aov aov = aovFromName(name, "output.aovs");
  const AovInfo& info = aovInfo(aov);
  switch (aov) {
    case Aov::Variance:
      return {info.name, info.channels, variance};
    case Aov::Samples:
      return {info.name, info.channels, render.result.film.sampleCounts()};
    default:
      return {info.name, info.channels, render.result.aovs.finished(aov)};
  }
}

double meanAlpha(const DifferentialFilm& film) {
  double covered = 0, count = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const DifferentialPixel pixel = film.at(x, y);
      covered += pixel.covered, count += pixel.count;
    }
  return covered / std::max(count, 1.0);
}

Messages warningsOf(const CompositeReport& report, double probeScale) {
  constexpr double kMinClamped = 0.01;
  Messages messages;
  if (const auto& r = report.reflectance; r && r->clampedFraction > kMinClamped)
    messages.push_back(
        {Message::Kind::Warning,
         fmt::format("{:.1f}% of the local scene's pixels need an albedo above 1 and were clamped: "
                     "the plate is {:.3g} times as bright as the model's own reflectance makes it; "
                     "plate and probe may differ in exposure",
                     100 * r->clampedFraction, r->exposureRatio),
         Remedy{"probe.scale", fmt::format("{:.2g}", probeScale * r->exposureRatio)}});
  if (report.darkerThanBlack)
    messages.push_back(
        {Message::Kind::Warning,
         fmt::format(
             "{} pixels would be negative, since the objects take more light than the plate "
             "has there, and are black: plate and probe may differ in exposure",
             report.darkerThanBlack)});
  return messages;
}

}  // namespace

JobResult renderComposite(const RenderJob& job, const LoadedScene& loaded,
                          const PreparedScene& prepared, const Progress& progress,
                          const std::atomic<bool>& stop) {
  const CompositePlan& plan = *job.composite;
  const bool solves = loaded.projection != nullptr, denoises = job.settings.denoise;
  const double share = denoises ? kRenderShare : 1;
  CompositeReport report;
  if (solves)
    report.reflectance = solveReflectance(
        job, loaded, prepared, [&](double fraction) { progress(share * fraction / 2); }, stop);
  const bool needsBehind = std::ranges::count(plan.layers, "l_noobj") > 0;
  CompositeRender rendered = renderComposite(
      *prepared.world, loaded.camera, *prepared.lighting, plan.plate, job.settings, plan.passes,
      needsBehind,
      [&](double fraction) { progress(share * (solves ? (1 + fraction) / 2 : fraction)); }, stop);
  const Composite composite = compose(rendered.film, rendered.mean, plan.plate, plan.mode);
  report.coverage = meanAlpha(rendered.film);
  report.darkerThanBlack = composite.darkerThanBlack;

  ImageNoise noise(compositeErrors(rendered.film, composite, std::move(rendered.errors)));
  OutputImage image;
  image.layers.push_back({"", "RGB", composite.color});
  for (const std::string& name : plan.layers)
    image.layers.push_back(layerOf(name, loaded, rendered, noise.variance));
  std::optional<DenoiseReport> denoised;
  if (denoises && !rendered.result.interrupted)
    denoised = addDenoised(
        [&](const Progress& part) {
          return denoiseComposite(rendered, plan.plate, plan.mode, part, stop);
        },
        progress, image);
  rendered.result.interrupted |= denoises && !denoised;
  Messages messages = warningsOf(report, job.file.settings.get<double>("probe.scale"));
  return {std::move(image), std::move(rendered.result), std::move(noise), report,
          denoised,         std::move(messages)};
}

}  // namespace chromeball

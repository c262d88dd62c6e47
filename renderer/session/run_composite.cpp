// SPDX-License-Identifier: Apache-2.0
#include "session/run_composite.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/local_scene.h"
#include "composite/reflectance.h"
#include "session/scene_lighting.h"

namespace chromeball {
namespace {

// Irradiance of the flat local scene.
Rgb flatIrradiance(const LoadedScene& loaded) {
  return irradianceOn(loaded.probe, *flatNormal(loaded.scene, loaded.isObject));
}

// Fills loaded.projection with the local scene's reflectance.
CompositeReport::Reflectance solveReflectance(const LoadedScene& loaded,
                                              const PreparedScene& prepared,
                                              const Progress& progress,
                                              const std::atomic<bool>& stop) {
  const RenderDescription& job = loaded.description;
  const ReflectanceProblem problem{*prepared.world, loaded.camera, *prepared.lighting,
                                   job.composite->plate};
  RenderSettings settings = job.settings;
  settings.denoise = false;  // only the composite is denoised
  settings.crop.reset();     // all parts of a render need the same reflectance
  settings.samples = settings.samplesOfAll();
  settings.shard = {};
  const ReflectanceSolution solution =
      job.composite->reflectance == CompositeDescription::Reflectance::Flat
          ? solveFlatReflectance(problem, settings, flatIrradiance(loaded), *loaded.projection,
                                 stop)
          : solveReflectance(problem, settings, job.composite->iterations, *loaded.projection,
                             progress, stop);
  const double clamped = double(solution.clamped) / double(std::max<size_t>(solution.pixels, 1));
  return {solution.pixels, clamped, solution.exposureRatio, solution.lastChange};
}

std::string scaledText(const glm::dvec3& scale) {
  if (scale.x == scale.y && scale.y == scale.z) return fmt::format("{:.2g}", scale.x);
  return fmt::format("{:.2g},{:.2g},{:.2g}", scale.x, scale.y, scale.z);
}

Messages warningsOf(const CompositeReport& report, const glm::dvec3& scale) {
  constexpr double kMinClamped = 0.01;
  Messages messages;
  if (const auto& r = report.reflectance; r && r->clampedFraction > kMinClamped)
    messages.push_back(
        {Message::Kind::Warning,
         fmt::format("{:.1f}% of the local scene's pixels need an albedo above 1 and were clamped: "
                     "the plate is {:.3g} times as bright as the model's own reflectance makes it; "
                     "plate and probe may differ in exposure",
                     100 * r->clampedFraction, r->exposureRatio),
         Remedy{"probe.scale", scaledText(r->exposureRatio * scale)}});
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

JobResult renderComposite(const LoadedScene& loaded, const PreparedScene& prepared,
                          const Progress& progress, const std::atomic<bool>& stop,
                          RenderControl* control) {
  const RenderDescription& job = loaded.description;
  const CompositeDescription& plan = *job.composite;
  const bool solves = loaded.projection != nullptr;
  const double share = job.settings.denoisesAtEnd() ? kRenderShare : 1;
  std::optional<CompositeReport::Reflectance> reflectance;
  if (solves)
    reflectance = solveReflectance(
        loaded, prepared, [&](double fraction) { progress(share * fraction / 2); }, stop);
  const bool needsBehind = std::ranges::count(plan.layers, "l_noobj") > 0;
  CompositeRender rendered = renderComposite(
      *prepared.world, loaded.camera, *prepared.lighting, plan.plate, job.settings, plan.passes,
      needsBehind,
      [&](double fraction) { progress(share * (solves ? (1 + fraction) / 2 : fraction)); }, stop,
      control);
  FinishedImage finished =
      finishComposite(finishPlan(loaded, rendered.result), rendered, progress, stop);
  finished.composite->reflectance = reflectance;
  Messages messages = warningsOf(*finished.composite, job.probe.scale);
  const auto& limit = job.settings.noiseLimit;
  if (limit && plan.passes == Passes::Two && !rendered.result.interrupted &&
      finished.noise.noise > *limit)
    messages.push_back(
        {Message::Kind::Warning,
         fmt::format("the noise of the composite is {:.3g}%, above the limit of {:g}%, "
                     "which holds for its first pass: it is relative to plate and "
                     "light of the scene together; give a smaller --noise",
                     100 * finished.noise.noise, 100 * *limit)});
  if (loaded.plateScale)  // nothing better is known
    for (Message& message : messages) message.remedy.reset();
  return {std::move(finished), std::move(rendered.result), std::move(messages)};
}

}  // namespace chromeball

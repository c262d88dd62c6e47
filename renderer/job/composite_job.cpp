// SPDX-License-Identifier: Apache-2.0
#include "job/composite_job.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/suggest.h"
#include "composite/local_scene.h"
#include "composite/plate.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

CompositeMode parseMode(const std::optional<NamedSetting>& mode) {
  if (!mode || mode->name == "difference") return CompositeMode::Difference;
  if (mode->name == "ratio") return CompositeMode::Ratio;
  throwInput("{}: `{}` is not known; {}", mode->location, mode->name,
             didYouMean(mode->name, {"difference", "ratio"}));
}

CompositeJob::Reflectance parseReflectance(const std::optional<NamedSetting>& reflectance) {
  using enum CompositeJob::Reflectance;
  if (!reflectance || reflectance->name == "model") return Model;
  if (reflectance->name == "plate") return Plate;
  if (reflectance->name == "flat") return Flat;
  throwInput("{}: `{}` is not known; {}", reflectance->location, reflectance->name,
             didYouMean(reflectance->name, {"model", "plate", "flat"}));
}

// Irradiance of the flat local scene.
Rgb flatIrradiance(const CompositeJob& job, const LoadedScene& loaded) {
  const glm::quat back =
      glm::angleAxis(-glm::radians(loaded.probe.rotationDegrees()), vec3(0, 1, 0));
  const vec3 normal = back * *flatNormal(loaded.scene, job.isObject);
  return Rgb(exactIrradiance(loaded.probe.latLong(), {&normal, 1})[0]);
}

// Finds the local scene's reflectance, and says what it came to.
void solve(CompositeJob& job, const RenderJob& render, const LoadedScene& loaded,
           const World& world, const LightingStrategy& lighting, const Progress& progress,
           const std::atomic<bool>& stop, nlohmann::json& details,
           std::vector<std::string>& notes) {
  constexpr int kIterations = 2;
  constexpr double kClampedToMention = 0.01;
  const ReflectanceProblem problem{world, loaded.camera, lighting, job.plate};
  const ReflectanceSolution solution =
      job.reflectance == CompositeJob::Reflectance::Flat
          ? solveFlatReflectance(problem, render.settings, flatIrradiance(job, loaded),
                                 *job.projection, stop)
          : solveReflectance(problem, render.settings,
                             render.file.composite->iterations.value_or(kIterations),
                             *job.projection, progress, stop);
  const double clamped = double(solution.clamped) / double(std::max<size_t>(solution.pixels, 1));
  details["reflectance"] = {{"pixels", solution.pixels},
                            {"clamped", clamped},
                            {"exposure_ratio", solution.exposureRatio},
                            {"last_change", solution.lastChange}};
  if (clamped > kClampedToMention)
    notes.push_back(fmt::format(
        "{:.1f}% of the local scene's pixels would have to reflect more than all light and were "
        "clamped: do plate and probe agree in exposure? The plate is {:.3g} times as bright as the "
        "model's own reflectance makes it (--probe-scale)",
        100 * clamped, solution.exposureRatio));
}

Layer layerOf(Aov aov, const CompositeJob& job, const CompositeRender& render,
              const Image& variance) {
  const AovInfo& info = aovInfo(aov);
  switch (aov) {
    case Aov::WithObjects:
    case Aov::WithoutObjects:
    case Aov::Difference:
    case Aov::Alpha:
      return {info.name, info.channels, ingredient(render.film, aov)};
    case Aov::Variance:
      return {info.name, info.channels, variance};
    case Aov::Reflectance:
      return {info.name, info.channels, job.projection->colors()};
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

}  // namespace

CompositeJob planComposite(RenderJob& job, bool twoPass) {
  const CompositeEntry& entry = *job.file.composite;
  if (job.settings.clamp && twoPass)
    throwInput("--clamp: leave it out; --two-pass is there to show what is right");
  CompositeJob composite;
  composite.mode = parseMode(entry.mode);
  composite.passes = twoPass ? Passes::Two : Passes::One;
  const Image plate = readPlate(entry.plate);
  if (!job.size) job.size = SceneFile::Size{plate.width, plate.height};
  composite.plate = scaledPlate(plate, job.size->width, job.size->height, entry.plate);

  composite.reflectance = parseReflectance(entry.reflectance);
  composite.layers = job.settings.aovs;
  const bool wantsReflectance =
      std::count(composite.layers.begin(), composite.layers.end(), Aov::Reflectance) > 0;
  if (wantsReflectance && composite.reflectance == CompositeJob::Reflectance::Model)
    throwInput(
        "{}: layer `reflectance` is found where [composite] has reflectance = \"plate\" or "
        "\"flat\"",
        entry.location);
  std::erase_if(job.settings.aovs, [](Aov aov) { return aov == Aov::Alpha || isOfComposite(aov); });
  return composite;
}

void prepareLocalScene(CompositeJob& composite, const RenderJob& job, LoadedScene& loaded) {
  const CompositeEntry& entry = *job.file.composite;
  Scene& scene = loaded.scene;
  composite.isObject = findObjects(scene, entry.localScene, entry.location);
  if (composite.reflectance == CompositeJob::Reflectance::Flat) {
    if (!flatNormal(scene, composite.isObject))
      throwInput("{}: the local scene is not flat; give \"plate\"", entry.reflectance->location);
    if (job.file.surroundings)
      throwInput("{}: needs a distant probe, and there are [surroundings]; give \"plate\"",
                 entry.reflectance->location);
  }
  if (composite.reflectance != CompositeJob::Reflectance::Model) {
    composite.projection =
        std::make_unique<Projection>(loaded.camera, job.settings.width, job.settings.height);
    makeProjected(scene, composite.isObject, *composite.projection);
  }
  if (entry.specular || entry.roughness)
    makeGlossy(scene, composite.isObject, entry.specular.value_or(1),
               entry.roughness.value_or(0.2f));
}

void sayPlateNotes(const CompositeEntry& entry) {
  std::string extension = std::filesystem::path(entry.plate).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
  for (const char* linear : {".exr", ".hdr", ".pic", ".pfm"})
    if (extension == linear) return;
  note(fmt::format("{}: decoded from sRGB", entry.plate));
}

Rendered renderComposite(CompositeJob& job, const RenderJob& render, const LoadedScene& loaded,
                         const World& world, const LightingStrategy& lighting,
                         const Progress& progress, const std::atomic<bool>& stop) {
  const bool solves = job.projection != nullptr;
  nlohmann::json details;
  std::vector<std::string> notes;
  if (solves)
    solve(
        job, render, loaded, world, lighting, [&](double fraction) { progress(fraction / 2); },
        stop, details, notes);
  const bool looksBehind =
      std::count(job.layers.begin(), job.layers.end(), Aov::WithoutObjects) > 0;
  CompositeRender rendered = renderComposite(
      world, loaded.camera, lighting, job.plate, render.settings, job.passes, looksBehind,
      [&](double fraction) { progress(solves ? (1 + fraction) / 2 : fraction); }, stop);
  const Composite composite = compose(rendered.film, rendered.mean, job.plate, job.mode);

  PictureNoise noise(compositeErrors(rendered.film, composite, std::move(rendered.errors)));
  OutputImage output;
  output.layers.push_back({"", "RGB", composite.color});
  for (Aov aov : job.layers) output.layers.push_back(layerOf(aov, job, rendered, noise.variance));
  Rendered out{std::move(rendered.result), std::move(output), std::move(noise), std::move(details),
               std::move(notes)};
  out.details["composite"] = {{"objects", meanAlpha(rendered.film)},
                              {"darker_than_black", composite.darkerThanBlack}};
  if (composite.darkerThanBlack)
    out.notes.push_back(
        fmt::format("{} pixels of the plate are darker than what the objects take from them, and "
                    "became black: is the plate's exposure the probe's?",
                    composite.darkerThanBlack));
  return out;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "session/run_composite.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "composite/local_scene.h"
#include "composite/plate.h"
#include "composite/reflectance.h"
#include "description/render_description.h"
#include "session/load_scene.h"
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
  const RenderDescription& description = loaded.description;
  const ReflectanceProblem problem{*prepared.world, loaded.camera, *prepared.lighting,
                                   description.composite->plate};
  RenderSettings settings = description.settings;
  settings.denoise = false;  // only the composite is denoised
  settings.crop.reset();     // all parts of a render need the same reflectance
  settings.samples = settings.samplesOfAll();
  settings.shard = {};
  const ReflectanceSolution solution =
      description.composite->reflectance == CompositeDescription::Reflectance::Flat
          ? solveFlatReflectance(problem, settings, flatIrradiance(loaded), *loaded.projection,
                                 stop)
          : solveReflectance(problem, settings, description.composite->iterations,
                             *loaded.projection, progress, stop);
  const double clamped = double(solution.clamped) / double(std::max<size_t>(solution.pixels, 1));
  return {solution.pixels, clamped, solution.exposureRatio, solution.lastChange};
}

std::string scaledText(const glm::dvec3& scale) {
  if (scale.x == scale.y && scale.y == scale.z) return fmt::format("{:.2g}", scale.x);
  return fmt::format("{:.2g},{:.2g},{:.2g}", scale.x, scale.y, scale.z);
}

// The composite's formula, and whether the plate gives the probe's scale.
struct Formula {
  CompositeMode mode;
  bool isScaledByPlate;
};

std::string cureOfDimLight(const CompositeReport::Reflectance& r, const Formula& formula) {
  const bool mayBeRatio = formula.mode == CompositeMode::Difference;
  if (formula.isScaledByPlate)
    return fmt::format("a smaller `ground_reflectance` in [composite] makes the light brighter{}",
                       mayBeRatio ? ", and mode = \"ratio\" darkens the plate itself" : "");
  if (r.exposureRatio > 1)
    return fmt::format(
        "plate and probe may differ in exposure: the light fits the plate at {:.3g} "
        "times its brightness",
        r.exposureRatio);
  return fmt::format("lamps that the probe does not have may light them{}",
                     mayBeRatio ? "; mode = \"ratio\" darkens the plate itself" : "");
}

Messages warningsOf(const CompositeReport& report, const glm::dvec3& scale,
                    const Formula& formula) {
  constexpr double kMinClamped = 0.01;
  Messages messages;
  if (const auto& r = report.reflectance; r && r->clampedFraction > kMinClamped) {
    addWarning(messages,
               "shadows are too faint on {:.1f}% of the local scene's pixels, which are brighter "
               "than white in this light (albedo above 1, clamped): {}",
               100 * r->clampedFraction, cureOfDimLight(*r, formula));
    if (!formula.isScaledByPlate && r->exposureRatio > 1)
      messages.back().remedy = Remedy{"probe.scale", scaledText(r->exposureRatio * scale)};
  }
  if (report.darkerThanBlack)
    addWarning(messages,
               "{} {} black, since the objects take more light there than the plate has: "
               "the light is too bright for the plate, or falls on things that the local scene "
               "lacks{}",
               report.darkerThanBlack, report.darkerThanBlack == 1 ? "pixel is" : "pixels are",
               formula.mode == CompositeMode::Difference
                   ? "; mode = \"ratio\" darkens the plate by a factor instead"
                   : "");
  return messages;
}

}  // namespace

FinishedRender renderComposite(const LoadedScene& loaded, const PreparedScene& prepared,
                               const RenderSettings& settings, const Progress& progress,
                               const Stop& stop, RenderControl* control) {
  const RenderDescription& description = loaded.description;
  const CompositeDescription& plan = *description.composite;
  const bool solves = loaded.projection != nullptr;
  const double share = description.settings.denoisesAtEnd() ? kRenderShare : 1;
  std::optional<CompositeReport::Reflectance> reflectance;
  if (solves)
    reflectance = solveReflectance(
        loaded, prepared, [&](double fraction) { progress(share * fraction / 2); }, stop.rendering);
  const bool needsBehind = std::ranges::count(plan.layers, "l_noobj") > 0;
  CompositeRender rendered = renderComposite(
      *prepared.world, loaded.camera, *prepared.lighting, plan.plate, settings, plan.passes,
      needsBehind,
      [&](double fraction) { progress(share * (solves ? (1 + fraction) / 2 : fraction)); },
      stop.rendering, control);
  FinishedImage finished =
      finishComposite(finishPlan(loaded, rendered.result), rendered, progress, stop.denoising);
  finished.composite->reflectance = reflectance;
  Messages messages = warningsOf(*finished.composite, description.probe.scale,
                                 {plan.mode, loaded.plateScale.has_value()});
  const auto& limit = description.settings.noiseLimit;
  if (limit && plan.passes == Passes::Two && !rendered.result.interrupted &&
      finished.noise.noise > *limit)
    addWarning(messages,
               "the noise of the composite is {:.3g}%, above the limit of {:g}%, "
               "which holds for its first pass: it is relative to plate and "
               "light of the scene together; give a smaller --noise",
               100 * finished.noise.noise, 100 * *limit);
  return {std::move(finished), std::move(rendered.result), std::move(messages)};
}

namespace {

// Whether the probe is not the only light, emitting surfaces aside.
bool hasLamps(const Scene& scene) {
  return !scene.lights.empty() || !scene.suns.empty() || !scene.ambient.empty();
}

constexpr std::string_view kGround = "ground";

// Whether the local scene names the ground, and no node of the models has that name.
bool namesTheGround(const CompositeEntry& entry, const Scene& scene) {
  return std::ranges::find(entry.localScene, kGround) != entry.localScene.end() &&
         std::ranges::find(scene.nodeNames, kGround) == scene.nodeNames.end();
}

bool hasGround(const CompositeDescription& composite, const Scene& scene) {
  using enum CompositeDescription::GroundPlane;
  return composite.ground == Always ||
         (composite.ground == IfNamed && namesTheGround(composite.entry, scene));
}

// The part inside a box or sphere.
Ground clipped(Ground ground, const Surroundings& around, const std::string& location) {
  const bool isBox = around.shape == Surroundings::Shape::Box;
  const float above = ground.height - around.center.y;
  const float side =
      std::sqrt(std::max(0.5f * (around.radius * around.radius - above * above), 0.0f));
  const vec2 centre(around.center.x, around.center.z);
  const vec2 min = isBox ? vec2(around.min.x, around.min.z) : centre - side;
  const vec2 max = isBox ? vec2(around.max.x, around.max.z) : centre + side;
  ground.min = glm::max(ground.min, min);
  ground.max = glm::min(ground.max, max);
  const bool isInside = !isBox || (ground.height >= around.min.y && ground.height <= around.max.y);
  if (!isInside || !(ground.min.x < ground.max.x && ground.min.y < ground.max.y))
    throwInput("{}: the ground is outside of [surroundings]; check its height", location);
  return ground;
}

void placeGround(const RenderDescription& description, LoadedScene& loaded) {
  const CompositeDescription& composite = *description.composite;
  const std::string location = description.origins.of(
      description.origins.has("composite.ground") ? "composite.ground" : "shadow-catcher");
  if (loaded.surroundings && loaded.room)
    throwInput(
        "{}: the ground needs a distant probe, or a box or sphere as [surroundings]; model it",
        location);
  const double height = composite.groundHeight - loaded.origin.y;
  const Bounds objects = bounds(loaded.scene);
  Ground ground = groundAround(
      loaded.camera, float(description.settings.width) / float(description.settings.height),
      objects, float(height), location);
  if (loaded.surroundings) ground = clipped(ground, *loaded.surroundings, location);
  const double depth = double(ground.height) - double(objects.min.y);
  if (depth > 1e-3 * glm::length(objects.size()))
    addWarning(loaded.messages,
               "{}: the model reaches {:.3g} m below the ground; move it, or give the ground a "
               "height of {:.3g}",
               location, depth, composite.groundHeight - depth);
  addGround(loaded.scene, ground, composite.entry.groundReflectance.value_or(kTypicalGround));
}

}  // namespace

void prepareLocalScene(LoadedScene& loaded) {
  RenderDescription& description = loaded.description;
  CompositeDescription& composite = *description.composite;
  const CompositeEntry& entry = composite.entry;
  Scene& scene = loaded.scene;
  const std::string location = description.origins.of("composite.entry");
  std::vector<NamedSetting> localScene;
  for (size_t i = 0; i < entry.localScene.size(); ++i)
    localScene.push_back({entry.localScene[i],
                          description.origins.of(elementName("composite.entry.localScene", i))});
  if (hasGround(composite, scene)) {
    std::erase_if(localScene, [&](const NamedSetting& node) { return node.name == kGround; });
    placeGround(description, loaded);
    localScene.push_back({kGroundNode, location});
  }
  loaded.isObject = findObjects(scene, localScene, location);
  if (!localScene.empty() && std::ranges::count(loaded.isObject, false) == 0)
    addWarning(
        loaded.messages,
        "{}: `{}`, the local scene, has no visible surface, so that no object changes its light",
        localScene.front().location, localScene.front().name);
  if (composite.choosesReflectance && hasLamps(scene))
    composite.reflectance = CompositeDescription::Reflectance::Plate;
  if (composite.reflectance == CompositeDescription::Reflectance::Flat) {
    const std::string reflectance = description.origins.of("composite.reflectance");
    if (!flatNormal(scene, loaded.isObject))
      throwInput("{}: the local scene is not flat; give \"plate\"", reflectance);
    if (isLayered(scene, loaded.isObject))
      throwInput(
          "{}: needs matte surfaces, and there are coats, sheen or transmission; give \"plate\"",
          reflectance);
    if (description.surroundings)
      throwInput("{}: needs a distant probe, and there are [surroundings]; give \"plate\"",
                 reflectance);
    if (hasLamps(scene))
      throwInput("{}: needs the probe as the only light, and there are lamps; give \"plate\"",
                 reflectance);
  }
  if (composite.reflectance != CompositeDescription::Reflectance::Model) {
    loaded.projection = std::make_unique<Projection>(loaded.camera, description.settings.width,
                                                     description.settings.height);
    makeProjected(scene, loaded.isObject, *loaded.projection);
  }
  if (composite.specular || composite.roughness)
    makeGlossy(scene, loaded.isObject, float(composite.specular.value_or(1)),
               float(composite.roughness.value_or(0.2)));
}

namespace {

Rgb groundReflectance(const CompositeDescription& composite, const std::vector<size_t>& pixels) {
  const CompositeEntry& entry = composite.entry;
  if (entry.groundReflectance) return *entry.groundReflectance;
  if (!composite.isPhotograph) return kTypicalGround;
  return Rgb(reflectanceInPhotograph(composite.plate, pixels, entry.groundReflectanceRange));
}

// The pixels that show the ground: as given, or around the objects, no farther from their box than
// its diagonal: there their shadows fall, while the rest of the plane is often not the ground in
// the photograph. All that show the plane if these are few.
std::vector<size_t> pixelsOfGround(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  if (const auto& part = description.composite->entry.groundInPlate)
    return pixelsIn(*part, description.settings.width, description.settings.height);
  constexpr size_t kFew = 64;
  Scene local = loaded.scene;
  local.instances.clear();
  Bounds objects;
  for (size_t i = 0; i < loaded.isObject.size(); ++i) {
    const Instance& instance = loaded.scene.instances[i];
    if (loaded.isObject[i])
      objects.add(bounds(loaded.scene, instance));
    else
      local.instances.push_back(instance);
  }
  const auto ground = std::ranges::find(local.nodeNames, kGroundNode);
  const auto within = [&](const Bounds& part) {
    return pixelsThatShow(int(ground - local.nodeNames.begin()), part, local, loaded.camera,
                          description.settings.width, description.settings.height);
  };
  const float reach = float(glm::length(objects.size()));
  const std::vector<size_t> around = within({objects.min - reach, objects.max + reach});
  return around.size() >= kFew ? around : within({vec3(-INFINITY), vec3(INFINITY)});
}

}  // namespace

void scaleProbeByPlate(LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  if (!description.probe.isScaledByPlate) return;
  const std::string location = description.origins.of("probe.scale");
  if (hasLamps(loaded.scene))
    throwInput(
        "{}: scale = \"plate\" needs the probe as the only light; the model has lights of its "
        "own: leave them out with `lights = \"off\"` in [lighting]",
        location);
  const std::vector<size_t> pixels = pixelsOfGround(loaded);
  const Rgb irradiance = irradianceOn(loaded.probe, vec3(0, 1, 0));
  const CompositeDescription& composite = *description.composite;
  const auto isPositive = [](const Rgb& c) { return c.x > 0 && c.y > 0 && c.z > 0; };
  if (pixels.empty()) throwInput("{}: no pixel shows the ground", location);
  if (!isPositive(irradiance))
    throwInput("{}: the probe gives the ground no light in one channel or all", location);
  PlateScale scale =
      scaleByPlate(composite.plate, pixels, irradiance, groundReflectance(composite, pixels));
  if (!isPositive(scale.scale) || !isFinite(scale.scale))
    throwInput("{}: the plate is black where it shows the ground, in one channel or all", location);
  loaded.probe = scaled(loaded.probe, scale.scale);
  loaded.sources = sourcesOf(description, loaded.loadedProbe, loaded.probe);
  setGroundReflectance(loaded.scene, scale.reflectance);
  loaded.plateScale = scale;
}

}  // namespace chromeball

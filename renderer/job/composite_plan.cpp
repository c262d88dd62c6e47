// SPDX-License-Identifier: Apache-2.0
#include "job/composite_plan.h"

#include <algorithm>

#include "base/error.h"
#include "composite/ground.h"
#include "composite/local_scene.h"
#include "composite/plate.h"
#include "composite/plate_scale.h"
#include "composite/reflectance.h"
#include "job/load_scene.h"
#include "job/render_job.h"

namespace chromeball {
namespace {

CompositePlan::Reflectance reflectanceNamed(const std::string& name) {
  using enum CompositePlan::Reflectance;
  return name == "plate" ? Plate : name == "flat" ? Flat : Model;
}

void planReflectance(const RenderJob& job, CompositePlan& composite) {
  using enum CompositePlan::Reflectance;
  const SceneFile& file = job.file;
  if (const auto name = file.settings.getIfGiven<std::string>("composite.reflectance")) {
    composite.reflectance = reflectanceNamed(*name);
  } else if (file.settings.get<bool>("composite.ground")) {
    const bool isSimple =
        file.composite->localScene.empty() && !file.surroundings && file.lamps.empty();
    composite.reflectance = isSimple ? Flat : Plate;
    composite.choosesReflectance = true;
  }
}

// Whether the probe is not the only light, emitting surfaces aside.
bool hasLamps(const Scene& scene) {
  return !scene.lights.empty() || !scene.suns.empty() || !scene.ambient.empty();
}

constexpr std::string_view kGround = "ground";

// `--shadow-catcher ground`, where no node is called so.
bool namesTheGround(const CompositeEntry& entry, const Scene& scene) {
  return std::ranges::any_of(entry.localScene,
                             [](const NamedSetting& node) { return node.name == kGround; }) &&
         std::ranges::find(scene.nodeNames, kGround) == scene.nodeNames.end();
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
    throwInput("{}: the ground is outside of [surroundings]; check `ground_height`", location);
  return ground;
}

void placeGround(const RenderJob& job, LoadedScene& loaded) {
  const Settings& settings = job.file.settings;
  const std::string location = settings.has("composite.ground")
                                   ? settings.location("composite.ground")
                                   : settings.location("shadow-catcher");
  if (loaded.surroundings && loaded.room)
    throwInput(
        "{}: the ground needs a distant probe, or a box or sphere as [surroundings]; model it",
        location);
  const double height = settings.get<double>("composite.ground_height") - loaded.origin.y;
  const Bounds objects = bounds(loaded.scene);
  Ground ground =
      groundAround(loaded.camera, float(job.settings.width) / float(job.settings.height), objects,
                   float(height), location);
  if (loaded.surroundings) ground = clipped(ground, *loaded.surroundings, location);
  const double depth = double(ground.height) - double(objects.min.y);
  if (depth > 1e-3 * glm::length(objects.size()))
    loaded.messages.push_back(
        {Message::Kind::Warning,
         fmt::format("{}: the model reaches {:.3g} m below the ground; move it, or give "
                     "`ground_height`",
                     location, depth)});
  addGround(loaded.scene, ground, job.file.composite->groundReflectance);
}

// What a compositor needs is always written: plate x (1 - alpha) x ratio + objects, or plate x (1 -
// alpha) + objects + difference.
void planShadowCatcher(RenderJob& job, CompositePlan& composite) {
  composite.mode = CompositeMode::ShadowCatcher;
  if (job.file.settings.has("composite.plate"))
    throwInput("{}: a shadow catcher is rendered without `plate`; leave one of them out",
               job.file.settings.location("composite.plate"));
  for (const char* key : {"reflectance", "iterations"})
    if (const std::string name = fmt::format("composite.{}", key); job.file.settings.has(name))
      throwInput("{}: a shadow catcher has no plate that tells its reflectance",
                 job.file.settings.location(name));
  for (const char* layer : {"objects", "alpha", "difference", "ratio"})
    if (std::ranges::count(composite.layers, layer) == 0) composite.layers.emplace_back(layer);
  std::erase(job.settings.aovs, Aov::Alpha);
}

}  // namespace

void planComposite(RenderJob& job) {
  const Settings& s = job.file.settings;
  CompositePlan& composite = job.composite.emplace();
  composite.layers = s.get<std::vector<std::string>>("output.aovs");
  composite.passes = s.get<bool>("two-pass") ? Passes::Two : Passes::One;
  if (isShadowCatcher(s)) return planShadowCatcher(job, composite);
  composite.mode = s.get<std::string>("composite.mode") == "ratio" ? CompositeMode::Ratio
                                                                   : CompositeMode::Difference;
  const std::string path = s.get<std::string>("composite.plate");
  const Image plate = readPlate(path, &composite.messages);
  if (!job.size) job.size = ImageSize{plate.width, plate.height};
  composite.plate = scaledPlate(plate, job.size->width, job.size->height, path);

  planReflectance(job, composite);
  composite.iterations = int(s.get<uint64_t>("composite.iterations"));
  if (s.has("composite.iterations") && composite.reflectance != CompositePlan::Reflectance::Plate)
    throwInput("{}: `iterations` is only for reflectance = \"plate\"",
               s.location("composite.iterations"));
  if (std::ranges::count(composite.layers, "reflectance") > 0 &&
      composite.reflectance == CompositePlan::Reflectance::Model)
    throwInput("{}: layer `reflectance` needs reflectance = \"plate\" or \"flat\" in [composite]",
               job.file.composite->location);
  std::erase(job.settings.aovs, Aov::Alpha);  // a composite's alpha is a layer of its own
}

void prepareLocalScene(RenderJob& job, LoadedScene& loaded) {
  CompositePlan& composite = *job.composite;
  const CompositeEntry& entry = *job.file.composite;
  const Settings& settings = job.file.settings;
  Scene& scene = loaded.scene;
  std::vector<NamedSetting> localScene = entry.localScene;
  if (settings.get<bool>("composite.ground") ||
      (settings.has("shadow-catcher") && namesTheGround(entry, scene))) {
    std::erase_if(localScene, [&](const NamedSetting& node) { return node.name == kGround; });
    placeGround(job, loaded);
    localScene.push_back({kGroundNode, entry.location});
  }
  loaded.isObject = findObjects(scene, localScene, entry.location);
  if (composite.choosesReflectance && hasLamps(scene))
    composite.reflectance = CompositePlan::Reflectance::Plate;
  if (composite.reflectance == CompositePlan::Reflectance::Flat) {
    if (!flatNormal(scene, loaded.isObject))
      throwInput("{}: the local scene is not flat; give \"plate\"",
                 settings.location("composite.reflectance"));
    if (isLayered(scene, loaded.isObject))
      throwInput(
          "{}: needs matte surfaces, and there are coats, sheen or transmission; give "
          "\"plate\"",
          settings.location("composite.reflectance"));
    if (job.file.surroundings)
      throwInput("{}: needs a distant probe, and there are [surroundings]; give \"plate\"",
                 settings.location("composite.reflectance"));
    if (hasLamps(scene))
      throwInput("{}: needs the probe as the only light, and there are lamps; give \"plate\"",
                 settings.location("composite.reflectance"));
  }
  if (composite.reflectance != CompositePlan::Reflectance::Model) {
    loaded.projection =
        std::make_unique<Projection>(loaded.camera, job.settings.width, job.settings.height);
    makeProjected(scene, loaded.isObject, *loaded.projection);
  }
  const auto specular = settings.getIfGiven<double>("composite.specular");
  const auto roughness = settings.getIfGiven<double>("composite.roughness");
  if (specular || roughness)
    makeGlossy(scene, loaded.isObject, float(specular.value_or(1)), float(roughness.value_or(0.2)));
}

void scaleProbeByPlate(const RenderJob& job, LoadedScene& loaded) {
  const auto& location = job.file.plateScale;
  if (!location) return;
  if (hasLamps(loaded.scene))
    throwInput(
        "{}: scale = \"plate\" needs the probe as the only light; the model has lights of its "
        "own: leave them out with `lights = \"off\"` in [lighting]",
        *location);
  Scene local = loaded.scene;
  local.instances.clear();
  for (size_t i = 0; i < loaded.isObject.size(); ++i)
    if (!loaded.isObject[i]) local.instances.push_back(loaded.scene.instances[i]);
  const auto ground = std::ranges::find(local.nodeNames, kGroundNode);
  const std::vector<size_t> pixels =
      pixelsThatShow(int(ground - local.nodeNames.begin()), local, loaded.camera,
                     job.settings.width, job.settings.height);
  const Rgb irradiance = irradianceOn(loaded.probe, vec3(0, 1, 0));
  const CompositeEntry& entry = *job.file.composite;
  const auto isPositive = [](const Rgb& c) { return c.x > 0 && c.y > 0 && c.z > 0; };
  if (pixels.empty()) throwInput("{}: no pixel shows the ground", *location);
  if (!isPositive(irradiance))
    throwInput("{}: the probe gives the ground no light in one channel or all", *location);
  PlateScale scale =
      scaleByPlate(job.composite->plate, pixels, irradiance, entry.groundReflectance);
  if (!isPositive(scale.scale) || !isFinite(scale.scale))
    throwInput("{}: the plate is black where it shows the ground, in one channel or all",
               *location);
  loaded.probe = scaled(loaded.probe, scale.scale);
  loaded.sources = sourcesOf(job, loaded.loadedProbe, loaded.probe);
  loaded.plateScale = scale;
}

}  // namespace chromeball

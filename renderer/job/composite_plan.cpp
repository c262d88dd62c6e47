// SPDX-License-Identifier: Apache-2.0
#include "job/composite_plan.h"

#include <algorithm>

#include "base/error.h"
#include "composite/local_scene.h"
#include "composite/plate.h"
#include "composite/reflectance.h"
#include "job/load_scene.h"
#include "job/render_job.h"

namespace chromeball {
namespace {

CompositePlan::Reflectance reflectanceNamed(const std::string& name) {
  using enum CompositePlan::Reflectance;
  return name == "plate" ? Plate : name == "flat" ? Flat : Model;
}

}  // namespace

void planComposite(RenderJob& job) {
  const Settings& s = job.file.settings;
  CompositePlan& composite = job.composite.emplace();
  composite.mode = s.get<std::string>("composite.mode") == "ratio" ? CompositeMode::Ratio
                                                                   : CompositeMode::Difference;
  composite.passes = s.get<bool>("two-pass") ? Passes::Two : Passes::One;
  const std::string path = s.get<std::string>("composite.plate");
  const Image plate = readPlate(path);
  if (!job.size) job.size = ImageSize{plate.width, plate.height};
  composite.plate = scaledPlate(plate, job.size->width, job.size->height, path);

  composite.reflectance = reflectanceNamed(s.get<std::string>("composite.reflectance"));
  composite.iterations = int(s.get<uint64_t>("composite.iterations"));
  if (s.has("composite.iterations") && composite.reflectance != CompositePlan::Reflectance::Plate)
    throwInput("{}: `iterations` is only for reflectance = \"plate\"",
               s.location("composite.iterations"));
  composite.layers = s.get<std::vector<std::string>>("output.aovs");
  if (std::ranges::count(composite.layers, "reflectance") > 0 &&
      composite.reflectance == CompositePlan::Reflectance::Model)
    throwInput("{}: layer `reflectance` needs reflectance = \"plate\" or \"flat\" in [composite]",
               job.file.composite->location);
  std::erase(job.settings.aovs, Aov::Alpha);  // a composite's alpha is a layer of its own
}

void prepareLocalScene(const RenderJob& job, LoadedScene& loaded) {
  const CompositePlan& composite = *job.composite;
  const CompositeEntry& entry = *job.file.composite;
  const Settings& settings = job.file.settings;
  Scene& scene = loaded.scene;
  loaded.isObject = findObjects(scene, entry.localScene, entry.location);
  if (composite.reflectance == CompositePlan::Reflectance::Flat) {
    if (!flatNormal(scene, loaded.isObject))
      throwInput("{}: the local scene is not flat; give \"plate\"",
                 settings.location("composite.reflectance"));
    if (job.file.surroundings)
      throwInput("{}: needs a distant probe, and there are [surroundings]; give \"plate\"",
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

}  // namespace chromeball

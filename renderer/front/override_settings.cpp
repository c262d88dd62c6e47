// SPDX-License-Identifier: Apache-2.0
#include "front/override_settings.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "front/arguments.h"
#include "front/scene_file_camera.h"

namespace chromeball {
namespace {

// Applies the settings that are stored per model.
void applyToModels(const Settings& over, SceneFile& file) {
  const Settings& all = file.settings;
  for (size_t i = 0; i < file.models.size(); ++i) {
    GltfChoice& choice = file.models[i].choice;
    const std::string animation = elementName("models", i) + ".choice.animation";
    for (const char* name : {"model.time", "model.animation"})
      if (over.has(name)) {
        if (!choice.animation) choice.animation.emplace();
        choice.animation->ifAny =
            (all.has("frames") || !file.probeTurns.empty()) && !over.has("model.animation");
        if (!file.origins.has(animation) || name == std::string_view("model.animation"))
          file.origins.set(animation, over.location(name));
      }
    if (const auto time = over.getIfGiven<double>("model.time")) choice.animation->seconds = *time;
    if (const auto name = over.getIfGiven<std::string>("model.animation"))
      choice.animation->name = *name;
    if (const auto variant = over.getIfGiven<std::string>("model.variant")) {
      choice.variant = {.name = *variant};
      file.origins.set(elementName("models", i) + ".choice.variant",
                       over.location("model.variant"));
    }
    choice.lightUnits = parseLightUnits(
        {all.get<std::string>("lighting.light_units"), all.location("lighting.light_units")});
    if (all.get<bool>("allow-external")) choice.external = ExternalFiles::Allow;
  }
}

// Before the first key and after the last one constant.
std::vector<double> rotationAt(const std::vector<ProbeTurn>& keys, double seconds) {
  const auto after = std::upper_bound(keys.begin(), keys.end(), seconds,
                                      [](double t, const auto& key) { return t < key.seconds; });
  if (after == keys.begin()) return keys.front().rotation;
  if (after == keys.end()) return keys.back().rotation;
  const ProbeTurn &from = *(after - 1), &to = *after;
  const double elapsed = seconds - from.seconds, duration = to.seconds - from.seconds;
  if (from.rotation.size() == 1 && to.rotation.size() == 1) {
    const double degrees = from.rotation.front();
    return {degrees + (to.rotation.front() - degrees) * elapsed / duration};
  }
  return between(parseRotation(from.rotation, "rotation_keys"),
                 parseRotation(to.rotation, "rotation_keys"), elapsed / duration)
      .numbers();
}

void mergeCamera(SceneFile& file, const Settings& over) {
  const auto path = over.getIfGiven<std::string>("camera.file");
  if (over.has("camera.name")) {
    if (path)
      throwInput("{}: excludes {}; give one", over.location("camera.file"),
                 over.location("camera.name"));
    if (file.settings.has("camera.file")) file.optics.reset();
    file.settings.erase("camera.file");
    file.camera.reset();
  }
  if (path) {
    file.settings.erase("camera.name");
    readCameraFile(*path, file);
  }
}

// --shadow-catcher NODE,...: a composite without a plate.
void applyShadowCatcher(SceneFile& file) {
  const auto nodes = file.settings.getIfGiven<std::string>("shadow-catcher");
  if (!nodes) return;
  const std::string location = file.settings.location("shadow-catcher");
  if (file.composite)
    throwInput("{}: the scene file has [composite]; give it mode = \"shadow-catcher\"", location);
  file.settings.set("composite.mode", std::string("shadow-catcher"), location);
  std::vector<std::string>& localScene = file.composite.emplace().localScene;
  file.origins.set("composite.entry", location);
  std::istringstream names(*nodes);
  for (std::string name; std::getline(names, name, ',');) {
    file.origins.set(elementName("composite.entry.localScene", localScene.size()), location);
    localScene.push_back(name);
  }
  if (localScene.empty()) throwInput("{}: names no node", location);
}

}  // namespace

void overrideSettings(SceneFile& file, const Settings& over) {
  mergeCamera(file, over);
  const std::string_view limits[] = {"render.samples", "render.time", "render.noise"};
  const auto isGiven = [&](std::string_view name) { return over.has(name); };
  if (std::any_of(std::begin(limits), std::end(limits), isGiven))  // the limits are one decision
    for (const std::string_view name : limits) file.settings.erase(name);
  if (over.has("probe.scale")) file.plateScale.reset();
  file.settings.merge(over);
  applyToModels(over, file);
  if (!file.probeTurns.empty() && !over.has("probe.rotation"))
    file.settings.set(
        "probe.rotation",
        rotationAt(file.probeTurns, over.getIfGiven<double>("model.time").value_or(0)));
  applyShadowCatcher(file);
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "front/arguments.h"
#include "front/quality.h"
#include "front/scene_file_sections.h"
#include "front/scene_values.h"
#include "front/toml_section.h"
#include "math/vec.h"

namespace chromeball {
namespace {

glm::quat readRotation(const Entry& entry) {
  if (entry.isArrayOf(4)) {
    const auto component = [&](size_t i) { return float(entry.element(i).number()); };
    const glm::quat q(component(3), component(0), component(1), component(2));
    if (!(glm::length(q) > 1e-6f) || !std::isfinite(glm::length(q)))
      entry.mustBe("a quaternion x, y, z, w of length above 0");
    return glm::normalize(q);
  }
  if (!entry.isArrayOf(3)) entry.mustBe("three angles in degrees or a quaternion x, y, z, w");
  const vec3 angles = glm::radians(entry.vector());
  return glm::angleAxis(angles.z, vec3(0, 0, 1)) * glm::angleAxis(angles.y, vec3(0, 1, 0)) *
         glm::angleAxis(angles.x, vec3(1, 0, 0));
}

vec3 readScale(const Entry& entry) {
  const vec3 scale = entry.oneOrThree();
  if (scale.x * scale.y * scale.z == 0) entry.mustBe("other than 0");
  return scale;
}

// `name`: the model's in the description.
ModelEntry readModel(const Entry& entry, const std::string& name, Origins& origins) {
  if (entry.node->is_string()) return {existingFile(entry), {}, {}};
  if (!entry.node->is_table()) entry.mustBe("a file name or a table");
  const Section model(entry.file, "model", *entry.node->as_table());
  ModelEntry result{existingFile(model.required("file")), {}, {}};
  Transform& placement = result.placement;
  if (const Entry e = model["rotation"]) placement.linear = glm::mat3_cast(readRotation(e));
  if (const Entry e = model["scale"]) {
    const vec3 scale = readScale(e);
    for (int axis = 0; axis < 3; ++axis) placement.linear[axis] *= scale[axis];
  }
  if (const Entry e = model["translation"]) {
    placement.translation = e.vector();
    result.translationRest = floatRest(e.point());
  }
  const Entry animation = model["animation"], time = model["time"];
  if (animation || time) {
    AnimationTime& when = result.choice.animation.emplace();
    origins.set(name + ".choice.animation", (animation ? animation : time).location());
    if (animation) when.name = animation.text();
    if (time) {
      when.seconds = time.number();
      origins.set(name + ".choice.animation.seconds", time.location());
    }
  }
  if (const Entry e = model["variant"]) {
    result.choice.variant = {.name = e.text()};
    origins.set(name + ".choice.variant", e.location());
  }
  return result;
}

void readProbeTurns(const Entry& keys, SceneFile& scene) {
  if (!keys) return;
  if (!keys.isArray() || keys.isArrayOf(0)) keys.mustBe(keys.setting->form);
  forEach(keys, [&](const Entry& key) {
    if (!key.isArrayOf(2)) key.mustBe("a pair [seconds, rotation]");
    const double seconds = key.element(0).number();
    if (!scene.probeTurns.empty() && !(seconds > scene.probeTurns.back().seconds))
      failAt(key.location(), "the times of `rotation_keys` must ascend: {:g} s is not after {:g} s",
             seconds, scene.probeTurns.back().seconds);
    Entry rotation = key.element(1);
    rotation.setting = findSetting("probe", "rotation");
    scene.probeTurns.push_back({seconds, rotation.numbers(), key.location()});
    parseRotation(scene.probeTurns.back().rotation, rotation.location());
  });
}

// Takes `scale = "plate"` out of [probe]; nullopt if it is a number. Returns the location.
std::optional<std::string> takePlateScale(const std::string& path, toml::table& table) {
  toml::table* probe = table["probe"].as_table();
  const toml::node* scale = probe ? probe->get("scale") : nullptr;
  if (!scale || !scale->is_string() || scale->as_string()->get() != "plate") return std::nullopt;
  const std::string location = locationIn(path, *scale);
  probe->erase("scale");
  return location;
}

}  // namespace

SceneFile readSceneFile(const std::string& path) {
  SceneFile scene = sceneOf(parseToml(path), path);
  if (scene.models.empty()) throwInput("{}: no `model`; name a .gltf or .glb file", path);
  return scene;
}

SceneFile sceneOf(toml::table table, const std::string& path) {
  const std::optional<std::string> plateScale = takePlateScale(path, table);
  const Section root(path, table,
                     {"model", "camera", "probe", "lighting", "light", "source", "render", "output",
                      "composite", "surroundings"});
  SceneFile scene;
  scene.path = path;
  scene.plateScale = plateScale;
  forEach(root["model"], [&](const Entry& e) {
    const std::string name = elementName("models", scene.models.size());
    scene.models.push_back(readModel(e, name, scene.origins));
  });
  for (const char* section : {"camera", "probe", "lighting", "render", "output"})
    root.section(section).read(scene.settings);
  readCamera(root.section("camera"), scene);
  readProbeTurns(root.section("probe")["rotation_keys"], scene);
  forEach(root["light"], [&](const Entry& e) {
    for (Lamp& lamp : readLamps(e, scene.lightLists)) scene.lamps.push_back(std::move(lamp));
  });
  forEach(root["source"], [&](const Entry& e) { readSources(e, scene); });
  if (root["composite"]) readComposite(root.section("composite"), scene);
  if (root["surroundings"]) {
    scene.origins.set("surroundings", root.section("surroundings").location());
    scene.surroundings = readSurroundings(root.section("surroundings"));
  }
  return scene;
}

SceneFile openScene(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".toml") return readSceneFile(path);
  if (extension != ".gltf" && extension != ".glb" && !beginsAsGltf(path))
    throwInput("{}: not a scene; give a scene file (.toml) or a model (.gltf, .glb)", path);
  SceneFile scene;
  scene.path = path;
  scene.models.push_back({path, {}, {}});
  return scene;
}

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
    choice.lightUnits = all.choice<LightUnits>("lighting.light_units");
    if (all.get<bool>("allow-external")) choice.external = ExternalFiles::Allow;
  }
}

// The rotation at a time; constant before the first key and after the last one.
std::vector<double> rotationAt(const std::vector<ProbeTurn>& keys, double seconds) {
  const auto after = std::ranges::upper_bound(keys, seconds, {}, &ProbeTurn::seconds);
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

// The options for a camera that frames the models take the place of the file's camera.
void mergeFraming(SceneFile& file, const Settings& over) {
  for (const char* name : {"camera.view", "camera.look_at_node"}) {
    if (!over.has(name)) continue;
    for (const char* other : {"camera.name", "camera.file"}) {
      if (over.has(other))
        throwInput("{}: excludes {}; give one", over.location(name), over.location(other));
      file.settings.erase(other);
    }
    if (file.camera) file.settings.erase("camera.fov"), file.optics.reset();
    file.camera.reset();
  }
}

void mergeCamera(SceneFile& file, const Settings& over) {
  mergeFraming(file, over);
  const auto path = over.getIfGiven<std::string>("camera.file");
  if (path || over.has("camera.name"))
    for (const char* replaced : {"camera.fov", "camera.view", "camera.look_at_node"})
      file.settings.erase(replaced);
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
  if (givesLimit(over) || over.has("render.quality")) eraseLimits(file.settings);
  if (over.has("probe.scale")) file.plateScale.reset();
  file.settings.merge(over);
  file.quality = applyQuality(file.settings);
  applyToModels(over, file);
  if (!file.probeTurns.empty() && !over.has("probe.rotation")) {
    file.origins.set("probe.rotation_keys", file.probeTurns.front().location);
    file.settings.set(
        "probe.rotation",
        rotationAt(file.probeTurns, over.getIfGiven<double>("model.time").value_or(0)));
  }
  applyShadowCatcher(file);
}

}  // namespace chromeball

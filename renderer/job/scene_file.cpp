// SPDX-License-Identifier: Apache-2.0
#include "job/scene_file.h"

#include <climits>

#include "job/scene_file_composite.h"
#include "job/scene_file_light.h"
#include "job/toml_section.h"

namespace chromeball {
namespace {

glm::quat readRotation(const Entry& entry) {
  if (entry.isArrayOf(4)) {
    const glm::quat q(entry.element(3).number(), entry.element(0).number(),
                      entry.element(1).number(), entry.element(2).number());
    if (!(glm::length(q) > 1e-6f) || !std::isfinite(glm::length(q)))
      entry.mustBe("a quaternion x, y, z, w of a length above 0");
    return glm::normalize(q);
  }
  if (!entry.isArrayOf(3)) entry.mustBe("three angles in degrees or a quaternion x, y, z, w");
  const vec3 angles = glm::radians(entry.vector());
  return glm::angleAxis(angles.z, vec3(0, 0, 1)) * glm::angleAxis(angles.y, vec3(0, 1, 0)) *
         glm::angleAxis(angles.x, vec3(1, 0, 0));
}

vec3 readScale(const Entry& entry) {
  const vec3 scale = entry.node->is_array() ? entry.vector() : vec3(entry.number());
  if (scale.x * scale.y * scale.z == 0) entry.mustBe("other than 0");
  return scale;
}

ModelEntry readModel(const Entry& entry) {
  if (entry.node->is_string()) return {existing(entry), {}, {}};
  if (!entry.node->is_table()) entry.mustBe("a file name or a table");
  const Section model(entry.file, "model", *entry.node->as_table(),
                      {"file", "translation", "rotation", "scale", "animation", "time", "variant"});
  if (!model["file"]) failAt(model.location(), "[model] has no `file`");

  ModelEntry result{existing(model["file"]), {}, {}};
  Transform& placement = result.placement;
  if (const Entry e = model["rotation"]) placement.linear = glm::mat3_cast(readRotation(e));
  if (const Entry e = model["scale"]) {
    const vec3 scale = readScale(e);
    for (int axis = 0; axis < 3; ++axis) placement.linear[axis] *= scale[axis];
  }
  if (const Entry e = model["translation"]) placement.translation = e.vector();
  const Entry animation = model["animation"], time = model["time"];
  if (animation || time) {
    AnimationTime& when = result.choice.animation.emplace();
    when.location = (animation ? animation : time).location();
    if (animation) when.name = animation.text();
    if (time) when.seconds = time.number();
  }
  if (const Entry e = model["variant"]) result.choice.variant = {e.text(), e.location()};
  return result;
}

void readLens(const Section& camera, SceneFile& scene) {
  const Entry aperture = camera["aperture"], focus = camera["focus"];
  if (!aperture && !focus) return;
  if (!aperture || !focus)
    failAt((aperture ? aperture : focus).location(),
           "`aperture` (the lens's diameter) and `focus` (a distance) go together, in metres");
  scene.lens = {float(aperture.positive()), float(focus.positive()), aperture.location()};
}

void readCamera(const Section& camera, SceneFile& scene) {
  readLens(camera, scene);
  const Entry name = camera["name"], position = camera["position"], target = camera["look_at"];
  if (name) {
    for (const char* key : {"position", "look_at", "up", "fov", "orthographic"})
      if (const Entry e = camera[key])
        failAt(e.location(), "[camera] has `name`, a camera of the model; it cannot have `{}` too",
               key);
    scene.cameraName = name.name();
    return;
  }
  const Entry orthographic = camera["orthographic"];
  if (!position && !target && !camera["up"] && !camera["fov"] && !orthographic) return;
  if (!position || !target)
    failAt(camera.location(), "[camera] needs `name`, or both `position` and `look_at`");

  const vec3 from = position.vector(), to = target.vector();
  const Entry upEntry = camera["up"], fovEntry = camera["fov"];
  if (orthographic && fovEntry)
    failAt(fovEntry.location(), "[camera] is `orthographic`; it has no `fov`");
  const vec3 up = upEntry ? upEntry.vector() : vec3(0, 1, 0);
  const float fov = fovEntry ? glm::radians(float(fovEntry.number(
                                   "degrees between 0 and 180",
                                   [](double degrees) { return degrees > 0 && degrees < 180; })))
                             : Camera().fov;
  if (fovEntry && fov < glm::radians(kPi))
    scene.warnings.push_back(fmt::format(
        "{}: `fov` is in degrees; {:g} is very narrow (as radians, it is {:.1f} degrees)",
        fovEntry.location(), glm::degrees(fov), glm::degrees(glm::degrees(fov))));
  try {
    scene.camera = Camera::lookAt(from, to, up, fov);
  } catch (const InputError& error) {
    failAt(camera.location(), "{}", error.what());
  }
  if (orthographic) {
    scene.camera->orthographic = true;
    scene.camera->halfHeight = 0.5f * float(orthographic.positive());
  }
}

void readProbe(const Section& probe, SceneFile& scene) {
  if (const Entry e = probe["file"]) scene.probe = existing(e);
  if (const Entry e = probe["mapping"]) scene.probeMapping = e.name();
  if (const Entry e = probe["rotation"]) scene.probeRotation = e.number();
  if (const Entry e = probe["scale"])
    scene.probeScale =
        float(e.number("a finite number, 0 or above", [](double x) { return x >= 0; }));
}

void readLighting(const Section& lighting, SceneFile& scene) {
  if (const Entry e = lighting["strategy"]) scene.strategy = e.name();
  if (const Entry e = lighting["mis"]) scene.mis = e.name();
  if (const Entry e = lighting["light_units"]) scene.lightUnits = e.name();
  const Entry lights = lighting["lights"];
  if (!lights) return;
  const bool off = lights.node->is_string() && lights.text() == "off";
  const auto isFactor = [](double x) { return x >= 0; };
  scene.modelLights = off ? 0 : float(lights.number("\"off\" or a factor, 0 or above", isFactor));
}

void readRender(const Section& render, SceneFile& scene) {
  if (const Entry e = render["size"]) {
    if (!e.isArrayOf(2)) e.mustBe("[width, height]");
    scene.size = {int(e.element(0).integer(1, 65536)), int(e.element(1).integer(1, 65536))};
  }
  if (const Entry e = render["samples"]) scene.samples = uint32_t(e.integer(1, kMaxSamples));
  if (const Entry e = render["max_depth"]) scene.maxDepth = int(e.integer(0, kMaxDepth));
  if (const Entry e = render["max_transmission_depth"])
    scene.maxTransmissionDepth = int(e.integer(0, kMaxDepth));
  if (const Entry e = render["single_sided"]) scene.singleSided = e.name();
  if (const Entry e = render["seed"]) scene.seed = uint64_t(e.integer(0, INT64_MAX));
  if (const Entry e = render["time"]) scene.timeLimit = e.positive();
  if (const Entry e = render["noise"]) scene.noiseLimit = e.positive() / 100;
}

}  // namespace

SceneFile readSceneFile(const std::string& path) {
  const toml::table table = parseToml(path);
  const Section root(path, "", table,
                     {"model", "camera", "probe", "lighting", "light", "render", "output",
                      "composite", "surroundings"});

  SceneFile scene;
  forEach(root["model"], [&](const Entry& e) { scene.models.push_back(readModel(e)); });
  if (scene.models.empty()) throwInput("{}: no `model`; name a .gltf or .glb file", path);
  readCamera(root.section("camera", {"name", "position", "look_at", "up", "fov", "orthographic",
                                     "aperture", "focus"}),
             scene);
  readProbe(root.section("probe", {"file", "mapping", "rotation", "scale"}), scene);
  readLighting(root.section("lighting", {"strategy", "mis", "lights", "light_units"}), scene);
  forEach(root["light"], [&](const Entry& e) { scene.lamps.push_back(readLamp(e)); });
  readRender(root.section("render", {"size", "samples", "max_depth", "max_transmission_depth",
                                     "single_sided", "seed", "time", "noise"}),
             scene);
  if (root["composite"]) scene.composite = readComposite(root);
  if (root["surroundings"]) scene.surroundings = readSurroundings(root);
  const Section output = root.section("output", {"file", "aovs"});
  forEach(output["file"], [&](const Entry& e) { scene.outputs.push_back(resolved(e)); });
  forEach(output["aovs"], [&](const Entry& e) { scene.aovs.push_back(e.name()); });
  return scene;
}

}  // namespace chromeball

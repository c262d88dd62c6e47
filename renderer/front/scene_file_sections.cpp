// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "base/error.h"
#include "image/io/output_file.h"

namespace chromeball {
namespace {

constexpr std::string_view kPlace[] = {"position", "look_at", "up", "orthographic"};
constexpr std::string_view kFraming[] = {"view", "look_at_node"};

void refuse(const Section& camera, std::span<const std::string_view> keys, std::string_view owner) {
  for (const std::string_view key : keys)
    if (const Entry e = camera[key])
      failAt(e.location(), "[camera] has {}; it cannot have `{}` too", owner, key);
}

void readLens(const Section& camera, SceneFile& scene) {
  const Entry aperture = camera["aperture"], focus = camera["focus"];
  if (!aperture && !focus) return;
  if (!aperture || !focus)
    failAt((aperture ? aperture : focus).location(),
           "`aperture` (the lens's diameter) and `focus` (a distance) go together, in metres");
  scene.lens = {float(aperture.number()), float(focus.number())};
  scene.origins.set("camera.lens", aperture.location());
}

void readOptics(const Section& camera, SceneFile& scene) {
  const Entry point = camera["principal_point"], distortion = camera["distortion"];
  if (!point && !distortion) return;
  Optics& optics = scene.optics.emplace();
  scene.origins.set("camera.optics", (distortion ? distortion : point).location());
  if (point) {
    if (!point.isArrayOf(2)) point.mustBe(point.setting->form);
    optics.principalPoint = vec2(point.element(0).number(), point.element(1).number());
  }
  if (!distortion) return;
  if (distortion.isArrayOf(2))
    optics.distortion = {distortion.element(0).number(), distortion.element(1).number()};
  else if (distortion.node->is_number())
    optics.distortion.k1 = distortion.number();
  else
    distortion.mustBe(distortion.setting->form);
}

void readPlace(const Section& camera, SceneFile& scene) {
  const Entry position = camera["position"], target = camera["look_at"];
  const Entry orthographic = camera["orthographic"];
  const Entry upEntry = camera["up"], fovEntry = camera["fov"];
  if (!position && !target && !upEntry && !orthographic) return;
  if (!position && !target)
    for (const std::string_view framing : kFraming)
      if (camera[framing]) refuse(camera, kPlace, fmt::format("`{}`", framing));
  if (!position || !target)
    failAt(camera.location(), "[camera] needs `name`, or both `position` and `look_at`");
  refuse(camera, kFraming, "a `position`");
  if (orthographic && fovEntry)
    failAt(fovEntry.location(), "[camera] is `orthographic`; it has no `fov`");
  const vec3 up = upEntry ? upEntry.vector() : vec3(0, 1, 0);
  const float fov = fovEntry ? glm::radians(float(fovEntry.number())) : Camera().fov;
  if (fovEntry && fov < glm::radians(kPi))
    scene.warnings.push_back(fmt::format(
        "{}: `fov` is in degrees; {:g} is very narrow (as radians, it is {:.1f} degrees)",
        fovEntry.location(), glm::degrees(fov), glm::degrees(glm::degrees(fov))));
  CameraEntry& entry = scene.camera.emplace();
  entry.position = position.point();
  entry.target = target.point();
  entry.up = up;
  scene.origins.set("camera.placed", camera.location());
  entry.lens.fov = fov;
  if (orthographic) {
    entry.lens.orthographic = true;
    entry.lens.halfHeight = 0.5f * float(orthographic.number());
  }
  try {
    entry.relativeTo(entry.position);
  } catch (const InputError& error) {
    failAt(camera.location(), "{}", error.what());
  }
}

void readGround(const Section& section, CompositeEntry& composite, Origins& origins) {
  if (const Entry e = section["ground_reflectance"]) composite.groundReflectance = e.oneOrThree();
  if (const Entry e = section["ground_reflectance_range"]) {
    if (!e.isArrayOf(2)) e.mustBe(e.setting->form);
    origins.set("composite.ground_reflectance_range", e.location());
    composite.groundReflectanceRange = vec2(e.element(0).number(), e.element(1).number());
    if (!(composite.groundReflectanceRange.x <= composite.groundReflectanceRange.y))
      e.mustBe("two numbers, the smaller one first");
  }
  if (const Entry e = section["ground_in_plate"]) {
    if (!e.isArrayOf(4)) e.mustBe(e.setting->form);
    origins.set("composite.ground_in_plate", e.location());
    vec4 part;
    for (int i = 0; i < 4; ++i) part[i] = float(e.element(size_t(i)).number());
    if (!(part.x < part.z && part.y < part.w))
      e.mustBe("[left, top, right, bottom], left before right and top before bottom");
    composite.groundInPlate = part;
  }
}

}  // namespace

void readCamera(const Section& camera, SceneFile& scene) {
  readLens(camera, scene);
  if (const Entry file = camera["file"]) {
    refuse(camera, kPlace, "a `file`");
    refuse(camera, kFraming, "a `file`");
    refuse(camera, std::array<std::string_view, 3>{"name", "principal_point", "distortion"},
           "a `file`");
    return readCameraFile(existingFile(file), scene);
  }
  readOptics(camera, scene);
  if (camera["name"]) {
    refuse(camera, kFraming, "`name`, a camera of the model");
    return refuse(camera, kPlace, "`name`, a camera of the model");
  }
  readPlace(camera, scene);
}

void readCameraFile(const std::string& path, SceneFile& scene) {
  const toml::table table = parseToml(path);
  const Section root(path, table, {"camera"});
  const Section camera = root.section("camera");
  for (const char* key :
       {"file", "name", "view", "look_at_node", "zoom", "shutter", "shutter_steps"})
    if (const Entry e = camera[key])
      failAt(e.location(), "a camera's own file has `position` and `look_at`, and no `{}`", key);
  if (scene.optics)
    scene.warnings.push_back(fmt::format(
        "{}: `principal_point` and `distortion` go with the scene's own camera, which {} replaces",
        scene.origins.of("camera.optics"), path));
  scene.camera.reset();
  scene.optics.reset();
  readPlace(camera, scene);
  if (!scene.camera) throwInput("{}: has no [camera] with `position` and `look_at`", path);
  readOptics(camera, scene);
  if (!scene.lens) readLens(camera, scene);
}

dvec3 lookAt(const SolvedCamera& camera) {
  const double distance = std::max({camera.distance, glm::length(camera.position), 1e-3});
  return camera.position - distance * camera.axes[2];
}

void writeCameraFile(const std::string& path, const SolvedCamera& camera,
                     const std::vector<std::string>& comments) {
  const auto vector = [](const dvec3& v) {
    return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", v.x, v.y, v.z);
  };
  std::string text;
  for (std::string comment : comments) {
    std::ranges::replace_if(
        comment, [](char c) { return c < ' ' || c > '~'; }, '?');  // it may not be UTF-8
    text += "# " + comment + "\n";
  }
  text += fmt::format("[camera]\nposition = {}\nlook_at = {}\nup = {}\nfov = {:.10g}\n",
                      vector(camera.position), vector(lookAt(camera)), vector(camera.axes[1]),
                      glm::degrees(camera.fov()));
  if (camera.principalPoint != dvec2(0.5))
    text += fmt::format("principal_point = [{:.10g}, {:.10g}]\n", camera.principalPoint.x,
                        camera.principalPoint.y);
  if (camera.distortion)
    text += fmt::format("distortion = [{:.10g}, {:.10g}]\n", camera.distortion.k1,
                        camera.distortion.k2);
  writeText(path, text);
}

void readComposite(const Section& section, SceneFile& scene) {
  Settings& settings = scene.settings;
  section.read(settings);
  if (!isShadowCatcher(settings)) section.required("plate");
  CompositeEntry& composite = scene.composite.emplace();
  scene.origins.set("composite.entry", section.location());
  const bool hasGround = settings.get<bool>("composite.ground");
  const Entry local = section["local_scene"];
  if (!local && !hasGround)
    failAt(section.location(),
           "[composite] has no `local_scene`; name its nodes, or give `ground = true` for a plane");
  forEach(local, [&](const Entry& e) {
    scene.origins.set(elementName("composite.entry.localScene", composite.localScene.size()),
                      e.location());
    composite.localScene.push_back(e.text());
  });
  if (local && composite.localScene.empty())
    failAt(local.location(), "`local_scene` must name at least one node");
  for (const char* key :
       {"ground_height", "ground_reflectance", "ground_reflectance_range", "ground_in_plate"})
    if (const Entry e = section[key]; e && !hasGround)
      failAt(e.location(), "`{}` needs `ground = true`", key);
  readGround(section, composite, scene.origins);
}

SurroundingsEntry readSurroundings(const Section& section) {
  const auto need = [&](const char* key) { return section.required(key); };
  const std::string shape = need("shape").choice();
  SurroundingsEntry s;
  if (shape == "box") {
    section.allowOnly({"shape", "min", "max", "capture"}, "a box");
    s.shape.shape = Surroundings::Shape::Box;
    s.min = need("min").point(), s.max = need("max").point();
    if (!glm::all(glm::lessThan(s.min, s.max)))
      failAt(section.location(), "[surroundings]: `max` must be above `min` along each axis");
    s.capture = 0.5 * (s.min + s.max);
  } else if (shape == "sphere") {
    section.allowOnly({"shape", "center", "radius", "capture"}, "a sphere");
    s.shape.shape = Surroundings::Shape::Sphere;
    s.capture = s.center = need("center").point();
    s.shape.radius = float(need("radius").number());
  } else {
    section.allowOnly({"shape", "file", "capture"}, "a model");
    s.shape.shape = Surroundings::Shape::Model;
    s.shape.model = existingFile(need("file"));
    s.capture = need("capture").point();
    return s;
  }
  if (const Entry e = section["capture"]) s.capture = e.point();
  const Surroundings here = s.relativeTo(s.capture);
  if (!here.contains(here.capture))
    failAt(section.location(),
           "[surroundings]: `capture`, where the probe was captured, lies outside");
  return s;
}

}  // namespace chromeball

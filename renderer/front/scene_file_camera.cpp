// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file_camera.h"

#include <array>
#include <span>

#include "base/error.h"

namespace chromeball {
namespace {

constexpr std::string_view kPlace[] = {"position", "look_at", "up", "fov", "orthographic"};

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
  if (!position && !target && !camera["up"] && !camera["fov"] && !orthographic) return;
  if (!position || !target)
    failAt(camera.location(), "[camera] needs `name`, or both `position` and `look_at`");

  const Entry upEntry = camera["up"], fovEntry = camera["fov"];
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

}  // namespace

void readCamera(const Section& camera, SceneFile& scene) {
  readLens(camera, scene);
  if (const Entry file = camera["file"]) {
    refuse(camera, kPlace, "a `file`");
    refuse(camera, std::array<std::string_view, 3>{"name", "principal_point", "distortion"},
           "a `file`");
    return readCameraFile(existingFile(file), scene);
  }
  readOptics(camera, scene);
  if (camera["name"]) return refuse(camera, kPlace, "`name`, a camera of the model");
  readPlace(camera, scene);
}

void readCameraFile(const std::string& path, SceneFile& scene) {
  const toml::table table = parseToml(path);
  const Section root(path, table, {"camera"});
  const Section camera = root.section("camera");
  for (const char* key : {"file", "name"})
    if (const Entry e = camera[key])
      failAt(e.location(), "a camera's own file has `position` and `look_at`, and no `{}`", key);
  scene.camera.reset();
  scene.optics.reset();
  readPlace(camera, scene);
  if (!scene.camera) throwInput("{}: has no [camera] with `position` and `look_at`", path);
  readOptics(camera, scene);
  if (!scene.lens) readLens(camera, scene);
}

}  // namespace chromeball

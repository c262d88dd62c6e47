// SPDX-License-Identifier: Apache-2.0
#include "session/choose_camera.h"

#include "base/error.h"
#include "base/text.h"
#include "description/render_description.h"
#include "scene/framing.h"

namespace chromeball {
namespace {

Camera chooseWithoutLens(const RenderDescription& job, const Scene& scene,
                         const AutomaticView& view) {
  if (const auto& placed = job.camera.placed) try {
      return placed->relativeTo(view.origin);
    } catch (const InputError& error) {
      throwInput("{}: {}", job.origins.of("camera.placed"), error.what());
    }
  if (const auto& wanted = job.camera.name) {
    std::vector<std::string_view> names;
    for (const auto name : {&Camera::name, &Camera::node})
      for (const Camera& camera : scene.cameras) {
        if (camera.*name == *wanted) return camera;
        if (std::count(names.begin(), names.end(), camera.*name) == 0)
          names.push_back(camera.*name);
      }
    throwInput("{}: the model has no camera `{}`; {}", job.origins.of("camera.name"), *wanted,
               names.empty() ? "it has none" : didYouMean(*wanted, names));
  }
  if (!scene.cameras.empty()) return scene.cameras.front();
  return *view.camera;
}

Camera withLens(const RenderDescription& job, Camera camera) {
  const auto& lens = job.camera.lens;
  if (!lens) return camera;
  if (camera.orthographic)
    throwInput("{}: an orthographic camera has no lens; leave out `aperture` and `focus`",
               job.origins.of("camera.lens"));
  camera.lensRadius = 0.5f * lens->aperture;
  camera.focus = lens->focus;
  return camera;
}

Camera withOptics(const RenderDescription& job, Camera camera) {
  const auto& optics = job.camera.optics;
  if (!optics) return camera;
  if (camera.orthographic)
    throwInput(
        "{}: an orthographic camera has no lens; leave out `principal_point` and `distortion`",
        job.origins.of("camera.optics"));
  if (optics->principalPoint) camera.principalPoint = *optics->principalPoint;
  camera.distortion = optics->distortion;
  return camera;
}

}  // namespace

AutomaticView AutomaticView::seenFrom(const glm::dvec3& other) const {
  AutomaticView view = *this;
  const vec3 move(origin - other);
  view.origin = other;
  view.centre += move;
  if (view.camera) view.camera->position += move;
  return view;
}

AutomaticView automaticView(const RenderDescription& job, const Scene& scene,
                            const glm::dvec3& origin) {
  const RenderSettings& s = job.settings;
  const float aspect = float(s.width) / float(s.height);
  const bool turns = job.camera.turns;
  const bool isPlaced = job.camera.placed || job.camera.name;
  AutomaticView view{.origin = origin};
  if (turns) view.centre = centreOf(scene);
  if (!isPlaced && scene.cameras.empty())
    view.camera = turns ? framingCameraAround(scene, aspect) : framingCamera(scene, aspect);
  return view;
}

Camera chooseCamera(const RenderDescription& job, const Scene& scene, const AutomaticView& view) {
  return withOptics(job, withLens(job, chooseWithoutLens(job, scene, view)));
}

}  // namespace chromeball

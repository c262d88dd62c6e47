// SPDX-License-Identifier: Apache-2.0
#include "scene_notes.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "description/capabilities.h"

namespace chromeball {
namespace {

void addOwnCamera(const std::string& model, const Scene& scene, Messages& messages) {
  const Camera& camera = scene.cameras.front();
  const std::string& name = camera.name.empty() ? camera.node : camera.name;
  const std::string own = name.empty() ? "its camera" : fmt::format("its camera `{}`", name);
  if (scene.cameras.size() == 1) return addNote(messages, "{}: seen by {}", model, own);
  messages.push_back(
      {Message::Kind::Note,
       fmt::format("{}: seen by {}, the first of {}", model, own, scene.cameras.size()),
       Remedy{"camera.name", {}}});
}

double tenths(double x) { return std::round(10 * x) / 10 + 0.0; }  // not -0

// The view before `orbit`, and what `zoom` leaves of it.
void addChosenView(const std::string& model, const Camera& camera, float fov, Messages& messages) {
  const glm::dvec3 back(camera.back);
  const double azimuth = glm::degrees(std::atan2(back.x, back.z)),
               elevation = glm::degrees(std::asin(std::clamp(back.y, -1.0, 1.0)));
  messages.push_back(
      {Message::Kind::Note,
       fmt::format("{}: seen from azimuth {:.1f} and elevation {:.1f}, with a field of view of "
                   "{:.3g} degrees",
                   model, tenths(azimuth), tenths(elevation), glm::degrees(double(fov))),
       Remedy{"camera.view", {}}});
}

void addCamera(const LoadedScene& loaded, Messages& messages) {
  const CameraDescription& given = loaded.description.camera;
  if (given.placed || given.name || given.view) return;
  const std::string model = loaded.description.sceneName();
  if (loaded.view.camera)
    addChosenView(model, *loaded.view.camera, loaded.camera.fov, messages);
  else if (!loaded.scene.cameras.empty())
    addOwnCamera(model, loaded.scene, messages);
}

void addNoiseLimit(const RenderDescription& description, Messages& messages) {
  constexpr double kLikelyFraction = 0.05;  // percent
  const auto& limit = description.settings.noiseLimit;
  if (limit && 100 * *limit < kLikelyFraction && description.origins.has("render.noise"))
    addNote(messages, "{}: {:g}% of noise, not {:g}%", namedOrigin(description, "render.noise"),
            100 * *limit, 10000 * *limit);
}

}  // namespace

Messages sceneNotes(const LoadedScene& loaded) {
  Messages messages;
  addCamera(loaded, messages);
  addNoiseLimit(loaded.description, messages);
  return messages;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "session/place_models.h"

#include "composite/local_scene.h"
#include "math/vec.h"
#include "scene/bounds.h"

namespace chromeball {
namespace {

using glm::dmat3;
using glm::dvec3;
using GroundPlane = CompositeDescription::GroundPlane;

bool hasNamedGround(const RenderDescription& description) {
  return description.composite && description.composite->ground == GroundPlane::IfNamed;
}

dmat3 turnOf(const RenderDescription& description) {
  const double angle = glm::radians(description.stand.turntable.value_or(0));
  return glm::mat3_cast(glm::angleAxis(angle, dvec3(0, 1, 0)));
}

}  // namespace

bool needsStand(const RenderDescription& description) {
  const StandDescription& stand = description.stand;
  return stand.movesModels() || stand.hasGround || hasNamedGround(description);
}

std::optional<double> floorOf(const RenderDescription& description) {
  if (!description.stand.drops) return {};
  const auto& composite = description.composite;
  if (composite && composite->ground == GroundPlane::Always) return composite->groundHeight;
  return description.stand.height.value_or(0);
}

double dropOf(const RenderDescription& description, double lowest) {
  const std::optional<double> floor = floorOf(description);
  return floor ? *floor - lowest : 0;
}

std::vector<ModelEntry> standing(const RenderDescription& description,
                                 std::vector<ModelEntry> models, const AutomaticView& view) {
  if (!description.stand.movesModels()) return models;
  const dmat3 turn = turnOf(description);
  const dvec3 drop(0, dropOf(description, view.lowest), 0);
  for (ModelEntry& model : models) {
    Transform& placement = model.placement;
    const dvec3 at = dvec3(placement.translation) + model.translationRest;
    const dvec3 moved = view.axis + turn * (at - view.axis) + drop;
    placement = {glm::mat3(turn * dmat3(placement.linear)), vec3(moved)};
    model.translationRest = floatRest(moved);
  }
  return models;
}

void turnBackCameras(const RenderDescription& description, const AutomaticView& view,
                     const dvec3& origin, Scene& scene) {
  const dmat3 back = glm::transpose(turnOf(description));
  const dvec3 axis = view.axis - origin;
  for (Camera& camera : scene.cameras) {
    camera.position = vec3(axis + back * (dvec3(camera.position) - axis));
    for (vec3 Camera::*side : {&Camera::right, &Camera::up, &Camera::back})
      camera.*side = vec3(back * dvec3(camera.*side));
  }
}

void addGround(RenderDescription& description, const AutomaticView& view, const dvec3& origin,
               Scene& scene) {
  constexpr float kReach = 100;  // in sizes of the scene: ends within a degree of the horizon
  const StandDescription& stand = description.stand;
  const double height = stand.height.value_or(stand.drops ? 0 : view.lowest);
  if (hasNamedGround(description)) description.composite->groundHeight = height;
  if (!stand.hasGround || description.composite) return;
  const Bounds box = bounds(scene);
  if (box.empty()) return;
  const vec3 centre = 0.5f * (box.min + box.max);
  const vec2 middle(centre.x, centre.z);
  const float reach = kReach * float(glm::length(box.size()));
  addGround(scene, {float(height - origin.y), middle - reach, middle + reach}, kTypicalGround);
}

}  // namespace chromeball

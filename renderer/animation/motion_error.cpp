// SPDX-License-Identifier: Apache-2.0
#include "animation/motion_error.h"

#include <algorithm>

#include "animation/scene_motion.h"
#include "base/error.h"
#include "scene/camera.h"

namespace chromeball {
namespace {

double degreesBetween(const vec3& a, const vec3& b) {
  const glm::dvec3 u(a), v(b);
  return glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

// The largest angle between axes of the two frames.
double degreesBetween(const Camera& a, const Camera& b) {
  return std::max({degreesBetween(a.right, b.right), degreesBetween(a.up, b.up),
                   degreesBetween(a.back, b.back)});
}

}  // namespace

void MotionError::Way::addPlaces(const vec3& opening, const vec3& moved, const vec3& truth) {
  constexpr double kRounding = 1e-6;
  length = std::max(length, double(glm::distance(truth, opening)));
  miss = std::max(miss, glm::distance(truth, moved) - kRounding * glm::length(truth));
}

void MotionError::Way::addAngles(double fromOpening, double fromTruth) {
  constexpr double kRounding = 0.01;
  length = std::max(length, fromOpening);
  miss = std::max(miss, fromTruth - kRounding);
}

void MotionError::add(const Scene& scene, const Scene& then, float time) {
  const auto parts = partsIn(then, scene);
  for (size_t i = 0; i < parts.size(); ++i) {
    const Instance &instance = scene.instances[i], *truth = parts[i];
    if (!instance.moves || !truth) continue;
    const Mesh& opening = scene.meshes[size_t(instance.mesh)];
    const Mesh& mesh = then.meshes[size_t(truth->mesh)];
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const vec3 from = instance.point(opening.positions[v]);
      const vec3 moved =
          instance.motion ? instance.motion->point(v, instance.motion->at(time)) : from;
      vertices_.addPlaces(from, moved, truth->point(mesh.positions[v]));
    }
  }
  const auto lamps = lampsIn(then, scene);
  for (size_t i = 0; i < lamps.size(); ++i) {
    if (!lamps[i]) continue;
    const PunctualLight& lamp = scene.lights[i];
    const LampPose from = lamp.poseAt(0), moved = lamp.poseAt(time), truth = lamps[i]->poseAt(0);
    if (lamp.kind != PunctualLight::Kind::Directional)
      lamps_.addPlaces(from.position, moved.position, truth.position);
    if (lamp.kind != PunctualLight::Kind::Point)
      lampTurn_.addAngles(degreesBetween(truth.direction, from.direction),
                          degreesBetween(truth.direction, moved.direction));
  }
}

void MotionError::add(const Camera& camera, const Camera& then, float time) {
  const Camera moved = camera.motion ? MovingCamera(camera, 1).cameraAt(time) : camera;
  camera_.addPlaces(camera.position, moved.position, then.position);
  cameraTurn_.addAngles(degreesBetween(then, camera), degreesBetween(then, moved));
}

void MotionError::addTurn(double degrees, int steps) {
  if (std::fabs(degrees) >= 180.0 * steps) cameraTurn_.addAngles(180, 180);
}

std::vector<std::string> MotionError::warnings(const std::string& file, int steps) const {
  constexpr double kTolerance = 0.005;
  const std::string remedy =
      steps < kMostMotionSteps
          ? fmt::format("{} steps of the shutter are closer", std::min(4 * steps, kMostMotionSteps))
          : "a shorter shutter is closer";
  std::vector<std::string> lines;
  const auto check = [&](const Way& way, const char* moves, const char* whose, const char* unit) {
    if (way.miss <= kTolerance * way.length) return;
    lines.push_back(fmt::format(
        "{}: the {} by up to {:.2g} {} while the shutter is open, and {} step{} miss{} {} way by "
        "up to {:.2g} {}; {}",
        file, moves, way.length, unit, steps, steps == 1 ? "" : "s", steps == 1 ? "es" : "", whose,
        way.miss, unit, remedy));
  };
  check(vertices_, "models move", "their", "m");
  check(lamps_, "lamps move", "their", "m");
  check(lampTurn_, "lamps turn", "their", "degrees");
  check(camera_, "camera moves", "its", "m");
  check(cameraTurn_, "camera turns", "its", "degrees");
  return lines;
}

}  // namespace chromeball

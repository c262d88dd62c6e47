// SPDX-License-Identifier: Apache-2.0
#include "animation/scene_motion.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "base/error.h"
#include "scene/camera.h"

namespace chromeball {
namespace {

// Whether two parts have the same triangles with the same fronts. A mesh that a mirroring transform
// places has them wound the other way if it is stored in world space.
bool areSame(const Scene& sceneA, const Instance& a, const Scene& sceneB, const Instance& b) {
  const Mesh &meshA = sceneA.meshes[size_t(a.mesh)], &meshB = sceneB.meshes[size_t(b.mesh)];
  if (meshA.positions.size() != meshB.positions.size()) return false;
  if (a.mirrors() == b.mirrors()) return meshA.triangles == meshB.triangles;
  return std::ranges::equal(
      meshA.triangles, meshB.triangles,
      [](const Triangle& s, const Triangle& t) { return s == Triangle(t.x, t.z, t.y); });
}

// For each instance of `scene`, the same part in `other`; null if the node has other parts there,
// or ones that are turned inside out.
std::vector<const Instance*> partsIn(const Scene& other, const Scene& scene) {
  std::map<int, std::vector<const Instance*>> own, others;
  for (const Instance& instance : scene.instances) own[instance.node].push_back(&instance);
  for (const Instance& instance : other.instances) others[instance.node].push_back(&instance);
  std::vector<const Instance*> found(scene.instances.size(), nullptr);
  for (const auto& [node, parts] : own) {
    const std::vector<const Instance*>& there = others[node];
    if (there.size() != parts.size()) continue;
    for (size_t i = 0; i < parts.size(); ++i)
      if (areSame(scene, *parts[i], other, *there[i]))
        found[size_t(parts[i] - scene.instances.data())] = there[i];
  }
  return found;
}

// For each lamp of `scene`, the lamp of the same node in `other`; null if there is none.
std::vector<const PunctualLight*> lampsIn(const Scene& other, const Scene& scene) {
  std::map<int, const PunctualLight*> others;
  for (const PunctualLight& lamp : other.lights) others[lamp.node] = &lamp;
  std::vector<const PunctualLight*> found;
  for (const PunctualLight& lamp : scene.lights) {
    const auto there = others.find(lamp.node);
    found.push_back(there == others.end() ? nullptr : there->second);
  }
  return found;
}

InstanceMotion::Key keyOf(const Scene& scene, const Instance& instance) {
  return {scene.meshes.shared(size_t(instance.mesh)), instance.toWorld};
}

template <class Key>
bool areEqual(const std::vector<Key>& keys) {
  return std::ranges::all_of(keys, [&](const Key& key) { return key == keys.front(); });
}

// The keys of parts and lamps of a scene, the first ones from the scene itself.
struct Keys {
  std::vector<InstanceMotion> instances;
  std::vector<std::vector<LampPose>> lamps;

  explicit Keys(const Scene& scene) {
    for (const Instance& instance : scene.instances)
      instances.push_back({{keyOf(scene, instance)}});
    for (const PunctualLight& lamp : scene.lights) lamps.push_back({lamp.poseAt(0)});
  }

  // Adds the keys at a later time. Parts that the scene lacks then keep their last key, and their
  // node is `incomplete`.
  void add(const Scene& scene, const Scene& then, std::set<int>& incomplete) {
    const auto parts = partsIn(then, scene);
    for (size_t i = 0; i < parts.size(); ++i) {
      if (!parts[i]) incomplete.insert(scene.instances[i].node);
      if (scene.instances[i].moves)
        instances[i].keys.push_back(parts[i] ? keyOf(then, *parts[i]) : instances[i].keys.back());
    }
    const auto there = lampsIn(then, scene);
    for (size_t i = 0; i < there.size(); ++i) {
      if (!there[i]) incomplete.insert(scene.lights[i].node);
      lamps[i].push_back(there[i] ? there[i]->poseAt(0) : lamps[i].back());
    }
  }
};

// The nodes with parts or lamps.
std::set<int> nodesOf(const Scene& scene) {
  std::set<int> nodes;
  for (const Instance& instance : scene.instances) nodes.insert(instance.node);
  for (const PunctualLight& lamp : scene.lights) nodes.insert(lamp.node);
  return nodes;
}

}  // namespace

std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later) {
  const std::set<int> known = nodesOf(scene);
  std::set<int> incomplete;
  Keys keys(scene);
  for (const Scene& then : later) {
    keys.add(scene, then, incomplete);
    std::ranges::set_difference(nodesOf(then), known, std::inserter(incomplete, incomplete.end()));
  }
  for (size_t i = 0; i < scene.instances.size(); ++i)
    if (InstanceMotion& motion = keys.instances[i]; !areEqual(motion.keys)) {
      scene.instances[i].motion = std::make_shared<const InstanceMotion>(std::move(motion));
      scene.moves = true;
    }
  for (size_t i = 0; i < scene.lights.size(); ++i)
    if (std::vector<LampPose>& poses = keys.lamps[i]; !areEqual(poses)) {
      scene.lights[i].motion = std::make_shared<const std::vector<LampPose>>(std::move(poses));
      scene.moves = true;
    }
  std::vector<std::string> names;
  for (const int node : incomplete) names.push_back(scene.nodeNames[size_t(node)]);
  return names;
}

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

// SPDX-License-Identifier: Apache-2.0
#include "job/scene_motion.h"

#include <algorithm>
#include <map>
#include <set>

namespace chromeball {
namespace {

bool mirrors(const Instance& instance) {
  return instance.toWorld && glm::determinant(instance.toWorld->linear) < 0;
}

// By instance of `scene`, the same part in another scene of the same models; null if the node has
// other parts there, or ones that are turned inside out.
std::vector<const Instance*> partsIn(const Scene& other, const Scene& scene) {
  std::map<int, std::vector<const Instance*>> own, others;
  for (const Instance& instance : scene.instances) own[instance.node].push_back(&instance);
  for (const Instance& instance : other.instances) others[instance.node].push_back(&instance);
  std::vector<const Instance*> found(scene.instances.size(), nullptr);
  for (const auto& [node, parts] : own) {
    const std::vector<const Instance*>& there = others[node];
    if (there.size() != parts.size()) continue;
    for (size_t i = 0; i < parts.size(); ++i) {
      const Mesh &a = scene.meshes[size_t(parts[i]->mesh)],
                 &b = other.meshes[size_t(there[i]->mesh)];
      if (a.positions.size() == b.positions.size() && a.triangles == b.triangles &&
          mirrors(*parts[i]) == mirrors(*there[i]))
        found[size_t(parts[i] - scene.instances.data())] = there[i];
    }
  }
  return found;
}

InstanceMotion::Key keyOf(const Scene& scene, const Instance& instance) {
  return {scene.meshes.shared(size_t(instance.mesh)), instance.toWorld};
}

void moveLamps(const std::vector<Scene>& later, std::vector<PunctualLight>& lights) {
  for (size_t i = 0; i < lights.size(); ++i) {
    std::vector<LampPose> poses{lights[i].poseAt(0)};
    for (const Scene& scene : later)
      poses.push_back(scene.lights.size() == lights.size() ? scene.lights[i].poseAt(0)
                                                           : poses.back());
    if (std::ranges::all_of(poses, [&](const LampPose& pose) { return pose == poses.front(); }))
      continue;
    lights[i].motion = std::make_shared<const std::vector<LampPose>>(std::move(poses));
  }
}

}  // namespace

std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later) {
  std::vector<std::vector<const Instance*>> parts;
  for (const Scene& then : later) parts.push_back(partsIn(then, scene));
  std::set<int> incomplete;
  for (const Scene& then : later)
    for (const Instance& instance : then.instances)
      if (partsIn(scene, then)[size_t(&instance - then.instances.data())] == nullptr)
        incomplete.insert(instance.node);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    Instance& instance = scene.instances[i];
    if (!instance.moves) continue;
    InstanceMotion motion{{keyOf(scene, instance)}};
    for (size_t k = 0; k < later.size(); ++k) {
      if (!parts[k][i]) incomplete.insert(instance.node);
      motion.keys.push_back(parts[k][i] ? keyOf(later[k], *parts[k][i]) : motion.keys.back());
    }
    if (std::ranges::all_of(motion.keys,
                            [&](const InstanceMotion::Key& k) { return k == motion.keys[0]; }))
      continue;
    instance.motion = std::make_shared<const InstanceMotion>(std::move(motion));
    scene.moves = true;
  }
  moveLamps(later, scene.lights);
  scene.moves |= std::ranges::any_of(scene.lights, [](const auto& l) { return bool(l.motion); });
  std::vector<std::string> names;
  for (const int node : incomplete) names.push_back(scene.nodeNames[size_t(node)]);
  return names;
}

void MotionError::add(const Scene& scene, const Scene& then, float time) {
  const std::vector<const Instance*> parts = partsIn(then, scene);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!instance.motion || !parts[i]) continue;
    const InstanceMotion& motion = *instance.motion;
    const KeySpan span = motion.at(time);
    const InstanceMotion::Key truth = keyOf(then, *parts[i]);
    for (uint32_t v = 0; v < truth.mesh->positions.size(); ++v) {
      const vec3 place = truth.point(v);
      farthest = std::max(farthest, double(glm::distance(place, motion.keys.front().point(v))));
      deviation = std::max(deviation, double(glm::distance(place, motion.point(v, span))));
    }
  }
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "job/scene_motion.h"

#include <algorithm>
#include <set>

#include "job/match_scenes.h"

namespace chromeball {
namespace {

InstanceMotion::Key keyOf(const Scene& scene, const Instance& instance) {
  return {scene.meshes.shared(size_t(instance.mesh)), instance.toWorld};
}

template <class Key>
bool areEqual(const std::vector<Key>& keys) {
  return std::ranges::all_of(keys, [&](const Key& key) { return key == keys.front(); });
}

// Nodes of `scene` with parts or lamps that `other` lacks.
void addLacking(const Scene& scene, const Scene& other, std::set<int>& nodes) {
  const auto parts = partsIn(other, scene);
  for (size_t i = 0; i < parts.size(); ++i)
    if (!parts[i]) nodes.insert(scene.instances[i].node);
  const auto lamps = lampsIn(other, scene);
  for (size_t i = 0; i < lamps.size(); ++i)
    if (!lamps[i]) nodes.insert(scene.lights[i].node);
}

void moveInstances(Scene& scene, const std::vector<Scene>& later) {
  std::vector<InstanceMotion> motions;
  for (const Instance& instance : scene.instances) motions.push_back({{keyOf(scene, instance)}});
  for (const Scene& then : later) {
    const auto parts = partsIn(then, scene);
    for (size_t i = 0; i < parts.size(); ++i)
      if (scene.instances[i].moves)
        motions[i].keys.push_back(parts[i] ? keyOf(then, *parts[i]) : motions[i].keys.back());
  }
  for (size_t i = 0; i < motions.size(); ++i) {
    if (areEqual(motions[i].keys)) continue;
    scene.instances[i].motion = std::make_shared<const InstanceMotion>(std::move(motions[i]));
    scene.moves = true;
  }
}

void moveLamps(Scene& scene, const std::vector<Scene>& later) {
  std::vector<std::vector<LampPose>> motions;
  for (const PunctualLight& lamp : scene.lights) motions.push_back({lamp.poseAt(0)});
  for (const Scene& then : later) {
    const auto lamps = lampsIn(then, scene);
    for (size_t i = 0; i < lamps.size(); ++i)
      motions[i].push_back(lamps[i] ? lamps[i]->poseAt(0) : motions[i].back());
  }
  for (size_t i = 0; i < motions.size(); ++i) {
    if (areEqual(motions[i])) continue;
    scene.lights[i].motion = std::make_shared<const std::vector<LampPose>>(std::move(motions[i]));
    scene.moves = true;
  }
}

}  // namespace

std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later) {
  std::set<int> incomplete;
  for (const Scene& then : later) {
    addLacking(scene, then, incomplete);
    addLacking(then, scene, incomplete);
  }
  moveInstances(scene, later);
  moveLamps(scene, later);
  std::vector<std::string> names;
  for (const int node : incomplete) names.push_back(scene.nodeNames[size_t(node)]);
  return names;
}

}  // namespace chromeball

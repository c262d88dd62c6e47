// SPDX-License-Identifier: Apache-2.0
#include "animation/scene_motion.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace chromeball {
namespace {

InstanceMotion::Key keyOf(const Scene& scene, const Instance& instance) {
  return {scene.meshes.shared(size_t(instance.mesh)), instance.toWorld};
}

template <class Key>
bool areEqual(const std::vector<Key>& keys) {
  return std::ranges::all_of(keys, [&](const Key& key) { return key == keys.front(); });
}

// The keys of parts and lamps of a scene, the first those of the scene itself.
struct Keys {
  std::vector<InstanceMotion> instances;
  std::vector<std::vector<LampPose>> lamps;

  explicit Keys(const Scene& scene) {
    for (const Instance& instance : scene.instances)
      instances.push_back({{keyOf(scene, instance)}});
    for (const PunctualLight& lamp : scene.lights) lamps.push_back({lamp.poseAt(0)});
  }

  // Those at a later time. What the scene lacks then keeps its last, and its node is `incomplete`.
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

bool mirrors(const Instance& instance) {
  return instance.toWorld && glm::determinant(instance.toWorld->linear) < 0;
}

}  // namespace

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

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "animation/match_scenes.h"

#include <map>

namespace chromeball {
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

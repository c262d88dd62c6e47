// SPDX-License-Identifier: Apache-2.0
#include "composite/local_scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/suggest.h"

namespace chromeball {

ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location) {
  std::vector<bool> isLocal(scene.nodeNames.size());
  for (const NamedSetting& local : names) {
    bool known = false;
    for (size_t node = 0; node < scene.nodeNames.size(); ++node)
      if (scene.nodeNames[node] == local.name) isLocal[node] = known = true;
    if (!known) {
      const std::vector<std::string_view> all(scene.nodeNames.begin(), scene.nodeNames.end());
      throwInput("{}: local_scene: the model has no node `{}`; {}", local.location, local.name,
                 didYouMean(local.name, all));
    }
  }
  const auto isUnderLocal = [&](int node) {
    while (node >= 0 && !isLocal[node])
      node = scene.nodeParents.empty() ? -1 : scene.nodeParents[node];
    return node >= 0;
  };
  ObjectMask isObject;
  for (const Instance& instance : scene.instances) isObject.push_back(!isUnderLocal(instance.node));
  if (std::find(isObject.begin(), isObject.end(), true) == isObject.end())
    throwInput("{}: every node is part of the local scene; no objects are left to be composited",
               location);
  return isObject;
}

}  // namespace chromeball

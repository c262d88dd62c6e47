// SPDX-License-Identifier: Apache-2.0
#include "session/animation_times.h"

#include <algorithm>
#include <set>

#include "scene/gltf/load_gltf.h"
#include "scene/gltf/model_cache.h"

namespace chromeball {

std::vector<ModelEntry> modelsAt(std::vector<ModelEntry> models, double seconds) {
  for (ModelEntry& model : models)
    if (model.choice.animation) model.choice.animation->seconds = seconds;
  return models;
}

std::vector<double> timesOfChange(const std::vector<ModelEntry>& models, double seconds,
                                  size_t most, ModelCache& cache) {
  std::set<double> all;
  for (const ModelEntry& model : models) {
    GltfChoice choice = model.choice;
    choice.cache = &cache;
    for (const double change : animationChanges(model.file, choice, seconds)) all.insert(change);
  }
  std::vector<double> some;
  size_t i = 0;
  for (const double time : all)
    if (i++ * most / std::max(all.size(), most) >= some.size()) some.push_back(time);
  return some;
}

}  // namespace chromeball

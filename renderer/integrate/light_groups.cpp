// SPDX-License-Identifier: Apache-2.0
#include "integrate/light_groups.h"

#include <algorithm>

namespace chromeball {

LightGroups::LightGroups(const World& world, const LightingStrategy& lighting)
    : scene_(world.scene), ofNode_(world.scene.nodeNames.size(), -1) {
  const Scene& scene = world.scene;
  for (const std::string& name : lighting.groups()) add(name);
  countOfStrategy_ = names_.size();
  for (const auto& source : world.sources.all) {
    firstOfSource_.push_back(int(names_.size()));
    for (const std::string& name : source->groups()) add(name);
  }
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[size_t(instance.material)];
    if (!material.emits()) continue;
    int& group = material.unlit ? unlit_ : ofNode_[size_t(instance.node)];
    if (group < 0) group = add(material.unlit ? "unlit" : scene.nodeNames[size_t(instance.node)]);
  }
}

int LightGroups::add(const std::string& name) {
  std::string base = name.empty() ? "light" : name;
  for (char& c : base)
    if (c == '.' || c == ',' || c == '=' || uint8_t(c) <= ' ' || c == 127) c = '_';
  std::string unique = base;
  for (int i = 2; std::ranges::find(names_, unique) != names_.end(); ++i)
    unique = base + "_" + std::to_string(i);
  names_.push_back(unique);
  return int(names_.size()) - 1;
}

std::span<Rgb> GroupSums::startScratch() {
  scratch_.assign(groups_.countOfStrategy(), Rgb(0));
  return std::span(scratch_);
}

void GroupSums::addScratch(const Rgb& throughput) {
  for (size_t i = 0; i < scratch_.size(); ++i) sums_[i] += throughput * scratch_[i];
}

void GroupSums::addEscaped(const LightPoint& point, const vec3& wi, const Rgb& throughput) {
  lighting_.splitEscaped(point, wi, startScratch());
  addScratch(throughput);
}

void GroupSums::addBackground(const vec3& origin, const vec3& wi, const Rgb& throughput) {
  lighting_.splitBackground(origin, wi, startScratch());
  addScratch(throughput);
}

Sample GroupIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  GroupSums sums(groups_, tracer_.lighting(), context.layers, context.lightRadiances);
  context.groups = &sums;
  const Rgb whole = tracer_.radiance(camera.path(), camera.hit, context);
  context.groups = nullptr;
  const Rgb kept = context.clamp(whole);
  if (kept != whole && isFinite(whole)) {
    const float scale = maxComponent(absolute(kept)) / maxComponent(absolute(whole));
    for (Rgb& radiance : context.layers) radiance *= scale;
  }
  return kept;
}

}  // namespace chromeball

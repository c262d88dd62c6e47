// SPDX-License-Identifier: Apache-2.0
#include "transport/light_groups.h"

#include <algorithm>

#include "lighting/suns.h"
#include "transport/camera_samples.h"

namespace chromeball {
namespace {

// An EXR channel, with its layer's prefix, a number and ".R", has 255 bytes at most.
std::string shortened(const std::string& name) {
  constexpr size_t kMaxBytes = 200;
  size_t end = std::min(name.size(), kMaxBytes);
  while (end < name.size() && (uint8_t(name[end]) & 0xC0) == 0x80) --end;  // whole UTF-8 characters
  return name.substr(0, end);
}

// Without the characters that separate layers and gains.
std::string layerName(const std::string& name) {
  std::string layer = name.empty() ? "light" : shortened(name);
  for (char& c : layer)
    if (c == '.' || c == ',' || c == '=' || uint8_t(c) <= ' ' || c == 127) c = '_';
  return layer;
}

}  // namespace

LightGroups::LightGroups(const World& world, const LightSource& lighting)
    : scene_(world.scene), ofNode_(world.scene.nodeNames.size(), -1) {
  const Scene& scene = world.scene;
  const auto addSource = [&](const LightSource& source, bool isStrategy) {
    // The suns of the probe are a layer below its own; a lamp of that name is none.
    for (const std::string& name : source.groups())
      add(isStrategy && name == kSunsGroup ? name : layerName(name));
    ends_.push_back(names_.size());
  };
  addSource(lighting, true);
  for (const auto& source : world.sources.all) addSource(*source, false);
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[size_t(instance.material)];
    if (!material.emits()) continue;
    int& group = material.unlit ? unlit_ : ofNode_[size_t(instance.node)];
    if (group < 0)
      group = add(material.unlit ? "unlit" : layerName(scene.nodeNames[size_t(instance.node)]));
  }
}

int LightGroups::add(const std::string& base) {
  std::string unique = base;
  for (int& count = taken_[base]; ++count > 1;) {
    unique = base + "_" + std::to_string(count);
    if (taken_.try_emplace(unique, 1).second) break;
  }
  names_.push_back(unique);
  return int(names_.size()) - 1;
}

template <class Split>
void GroupSums::add(std::optional<size_t> source, const Rgb& throughput, const Split& split) {
  const auto [first, last] = groups_.rangeOf(source);
  scratch_.assign(last - first, Rgb(0));
  split(std::span(scratch_));
  for (size_t i = 0; i < scratch_.size(); ++i) sums_[first + i] += throughput * scratch_[i];
}

void GroupSums::addEscaped(const LightSource& light, std::optional<size_t> source,
                           const LightPoint& point, const vec3& wi, const Rgb& throughput) {
  if (isDirected(source)) return directions_[path_].push_back({wi, throughput});
  add(source, throughput,
      [&](std::span<Rgb> radiances) { light.splitEscaped(point, wi, radiances); });
}

void GroupSums::addBackground(const LightSource& light, std::optional<size_t> source,
                              const vec3& origin, const vec3& wi, const Rgb& throughput) {
  if (isDirected(source)) return directions_[path_].push_back({wi, throughput});
  add(source, throughput,
      [&](std::span<Rgb> radiances) { light.splitBackground(origin, wi, radiances); });
}

void GroupIntegrator::sampleMany(const CameraSamples& cameras, PathContext& context,
                                 std::span<Sample> samples) const {
  GroupSums sums(groups_, context.lightRadiances);
  context.groups = &sums;
  const std::span<const Rgb> radiances = PathBatch::traced(cameras, tracer_, context);
  context.groups = nullptr;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Rgb whole = radiances[i], kept = context.clamp(whole);
    samples[i] = kept;
    if (kept == whole || !isFinite(whole)) continue;
    const float scale = maxComponent(absolute(kept)) / maxComponent(absolute(whole));
    for (Rgb& radiance : cameras[i].layers) radiance *= scale;
  }
}

}  // namespace chromeball

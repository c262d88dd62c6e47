// SPDX-License-Identifier: Apache-2.0
// Light groups: the radiance of a picture by the source that it comes from (Madsen et al. 2003,
// section 4; HDRI book, section 9.9.1).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "transport/integrator.h"

namespace chromeball {

// The groups of a scene: first the strategy's, then the scene's sources (LightSource::groups()),
// each node that emits, and one for all unlit materials.
class LightGroups {
 public:
  LightGroups(const World& world, const LightSource& lighting);

  // Unique; without the characters that separate layers and gains: . , = and spaces, but for the
  // point of kSunsGroup.
  const std::vector<std::string>& names() const { return names_; }

  // The groups of the probe's strategy if `source` is null, else of one of World::sources: indices
  // of the first group and of the one after the last.
  std::array<size_t, 2> rangeOf(std::optional<size_t> source) const {
    const size_t i = source ? *source + 1 : 0;
    return {ends_[i], ends_[i + 1]};
  }
  int ofSample(std::optional<size_t> source, const DirectionSample& light) const {
    if (light.end.instance != LightEnd::kNone)
      return ofInstance(scene_.instances[light.end.instance]);
    return int(rangeOf(source)[0]) + light.group;
  }
  // The group of the radiance that an instance emits.
  int ofInstance(const Instance& instance) const {
    return scene_.materials[size_t(instance.material)].unlit ? unlit_
                                                             : ofNode_[size_t(instance.node)];
  }

 private:
  int add(const std::string& base);

  const Scene& scene_;
  std::vector<std::string> names_;
  std::vector<size_t> ends_{0};  // after the groups of the strategy, and of each source
  std::unordered_map<std::string, int> taken_;  // by name: how many lights have or had it
  int unlit_ = -1;
  std::vector<int> ofNode_;  // -1 for a node that does not emit
};

// The throughput of a path for unit radiance from one direction of the probe.
struct DirectedLight {
  vec3 wi;  // unit
  Rgb throughput;
};

// The sums to which a path adds its light by group, in addition to its whole radiance.
class GroupSums {
 public:
  // `scratch` keeps its capacity. `directions`, if not empty, gets the probe's light in place of
  // its groups: for each path, one entry each time that it finds the probe.
  GroupSums(const LightGroups& groups, std::vector<Rgb>& scratch,
            std::span<std::vector<DirectedLight>> directions = {})
      : groups_(groups), scratch_(scratch), directions_(directions) {}

  // The path whose light is added next. `sums`: one element per group.
  void select(size_t path, std::span<Rgb> sums) { path_ = path, sums_ = sums; }

  void addEmitted(const Instance& instance, const Rgb& radiance) {
    sums_[size_t(groups_.ofInstance(instance))] += radiance;
  }
  // Adds a sample of a delta light or a surface.
  void addSample(std::optional<size_t> source, const DirectionSample& light, const Rgb& radiance) {
    sums_[size_t(groups_.ofSample(source, light))] += radiance;
  }
  // `throughput` times the radiance of light.escaped(), by group. Each group is independent of the
  // others, so that its bits scale with those of its source. `source`: as for
  // LightGroups::rangeOf().
  void addEscaped(const LightSource& light, std::optional<size_t> source, const LightPoint& point,
                  const vec3& wi, const Rgb& throughput);
  // `throughput` times light.background().
  void addBackground(const LightSource& light, std::optional<size_t> source, const vec3& origin,
                     const vec3& wi, const Rgb& throughput);

 private:
  // Adds `throughput` times what split(radiances) adds to the groups of a source.
  template <class Split>
  void add(std::optional<size_t> source, const Rgb& throughput, const Split& split);

  bool isDirected(std::optional<size_t> source) const { return !directions_.empty() && !source; }

  const LightGroups& groups_;
  std::vector<Rgb>& scratch_;
  std::span<std::vector<DirectedLight>> directions_;
  size_t path_ = 0;
  std::span<Rgb> sums_;
};

// Path tracing of all instances; the layers are the groups, whose sum is the radiance up to
// rounding. A clamp scales all groups of a sample alike.
class GroupIntegrator : public Integrator {
 public:
  // `groups` must outlive this.
  GroupIntegrator(const PathTracer& tracer, const LightGroups& groups)
      : tracer_(tracer), groups_(groups) {}

  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const override;
  std::vector<Accumulation> layers() const override {
    return std::vector<Accumulation>(groups_.names().size(), Accumulation::Sum);
  }
  std::vector<std::string> groups() const override { return groups_.names(); }

 private:
  PathTracer tracer_;
  const LightGroups& groups_;
};

}  // namespace chromeball

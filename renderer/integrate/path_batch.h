// SPDX-License-Identifier: Apache-2.0
// Paths of one pixel that are traced together, a vertex of each at a time: their rays form packets,
// and their reads from the probe's tables and the meshes overlap.
#pragma once

#include <array>
#include <span>

#include "integrate/path.h"

namespace chromeball {

// The estimates are those of PathTracer::radiance(). Used again for the next paths, since clearing
// its arrays would take a noticeable part of the time.
class PathBatch {
 public:
  static constexpr size_t kMaxPaths = LightSource::kMaxMany;

  // Adds a path from a camera ray and its hit.
  void add(const PathState& start, const std::optional<Hit>& hit);

  // Traces all paths; path i is sample firstSample + i of the sampler's pixel.
  void trace(const PathTracer& tracer, uint32_t firstSample, PathContext& context);

  // The results, in the order of add().
  const Rgb& radiance(size_t i) const { return paths_[i].radiance; }

  void clear() { count_ = 0; }

 private:
  template <class T>
  struct List {
    std::array<T, kMaxPaths> items;
    size_t size = 0;

    void add(const T& item) { items[size++] = item; }
    std::span<T> all() { return std::span(items).first(size); }
  };
  using Indices = List<uint32_t>;  // of paths

  struct Task;
  void select(uint32_t path, Task& task);
  void endEscaped(Task& task);
  void drawLightSamples(Task& task);
  void shade(Task& task);
  void completeGuided(Task& task);
  void traceShadowRays(Task& task);
  void traceNextRays(Task& task);

  size_t count_ = 0;
  std::array<PathState, kMaxPaths> paths_;
  std::array<std::optional<Hit>, kMaxPaths> hits_;
  std::array<DeferredLight, kMaxPaths> lights_;
  Indices active_, shaded_;

  // Arguments and results of the functions that take several rays.
  List<Ray> rays_;
  List<uint32_t> keys_;
  List<LightSource::Escape> escapes_;
  List<glm::uvec2> numbers_;
  std::array<LightSource::Escaped, kMaxPaths> escaped_;
  std::array<DirectionSample, kMaxPaths> samples_;
  std::array<std::optional<Hit>, kMaxPaths> found_;
  std::array<Rgb, kMaxPaths> transmittances_;
};

}  // namespace chromeball

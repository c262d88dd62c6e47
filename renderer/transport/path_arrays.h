// SPDX-License-Identifier: Apache-2.0
// Paths that are followed together, in arrays.
#pragma once

#include <bit>
#include <utility>

#include "transport/camera_samples.h"

namespace chromeball {

// What guided bounces leave on paths, by the cameras' numbers (PathState).
struct GuidedPaths {
  LaneArray<float> ratio;                           // guideRatio
  std::array<GuidedBounce, kMostInArrays> bounces;  // the first of each, for its record
};

// What is followed, by which settings, and where the results go.
struct LaneTask {
  const CameraSamples& cameras;
  const PathTracer& tracer;
  PathContext& context;
  std::span<Rgb> radiances;
  GuidedPaths& guided;

  const World& world() const { return tracer.world(); }
  const PathSettings& settings() const { return tracer.settings(); }
  const LightSource& lighting() const { return tracer.lighting(); }
};

// Paths that are still followed, without gaps.
struct PathArrays {
  RayArrays rays;
  LaneArrays3 throughput;
  alignas(64) LaneArray<float> pdf;          // of the ray; 0: from the camera or a smooth mirror
  alignas(64) LaneArray<float> length;       // from the camera to the ray's origin
  alignas(64) LaneArray<int32_t> id;         // of the camera
  alignas(64) LaneArray<int32_t> scattered;  // -1 or 0, as in PathState
  // As in PathState; 0: no regularisation.
  alignas(64) LaneArray<float> widening, minAlpha;
  HitArrays hits;
  // The vertex at the ray's origin, if guides record it or lamps may be hit.
  bool keepsVertices = false;
  LaneArrays3 position, normal, throughputBefore;
  size_t size = 0;

  // Appends the paths of `from` at [i, i + 8) that are packed. `from` may be this, if no path
  // before them is still wanted where they go.
  void add(const PathArrays& from, size_t i, const LanePacking& packing);
  // Removes the paths of each eight whose bits isGone(first, here) returns; `here`: the bits of
  // those that exist.
  template <class IsGone>
  void removeIf(const IsGone& isGone) {
    const size_t count = std::exchange(size, 0);
    for (size_t i = 0; i < count; i += LanesOf<Float8>::kCount) {
      const unsigned here = bitsOf(firstLanes(count - i)), gone = isGone(i, here);
      if (gone == 0 && size == i)
        size += size_t(std::popcount(here));
      else
        add(*this, i, LanePacking(here & ~gone));
    }
  }
};

}  // namespace chromeball

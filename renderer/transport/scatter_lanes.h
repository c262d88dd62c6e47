// SPDX-License-Identifier: Apache-2.0
// Direct light and the next rays at the vertices of paths in arrays.
#pragma once

#include <array>
#include <vector>

#include "lighting/light_arrays.h"
#include "transport/path_arrays.h"
#include "transport/scene_light_lanes.h"
#include "transport/vertex_arrays.h"

namespace chromeball {

// PathTracer::scatter() at several vertices of plain surfaces. Keeps its memory.
class ScatterLanes {
 public:
  // Makes the vertices at the ends of the paths' rays.
  void fillVertices(const LaneTask& task, const PathArrays& paths);
  const VertexArrays& vertices() const { return vertices_; }

  // Adds the direct light of the vertices, which are at `depth`, but of hidden ones, to the
  // radiances, and makes `next` the paths that go on. `keys`: PixelSampler::vertexKey() of each.
  void scatter(const LaneTask& task, const PathArrays& paths, std::span<const uint32_t> keys,
               int depth, PathArrays& next);

 private:
  void drawNumbers(const LaneTask& task, const PathArrays& paths, int depth);
  void scatterLanes(const LaneTask& task, const PathArrays& paths, int depth, size_t first,
                    PathArrays& next);
  // The paths' guideRatio.
  static Float8 ratiosOf(const LaneTask& task, const PathArrays& paths, size_t first);
  static void noteGuided(const LaneTask& task, const PathArrays& paths, size_t first,
                         const GuidedBsdfLanes::Bounce& bounce, Int8 isHere, float fraction);
  void recordSamples(size_t first, unsigned lit, const BsdfLanesValue& value,
                     const Lanes3<Float8>& normal);
  void traceShadowRays(const LaneTask& task);

  VertexArrays vertices_;
  // By dimension: the bits of the random numbers of the vertices.
  alignas(64) std::array<LaneArray<uint32_t>, dimension::kPerVertex> numbers_;
  LightArrays lights_;
  SceneLightLanes sceneLights_;

  struct ShadowRays {
    RayArrays rays;
    LaneArrays3 radiance;  // at the camera, if nothing is in the way
    alignas(64) LaneArray<int32_t> id;
    size_t size = 0;
    std::vector<LightRecord> records;  // if they are wanted
  } shadows_;

  std::array<Rgb, kMostInArrays> transmittances_;
  std::array<float, kMostInArrays> crossSections_;
};

}  // namespace chromeball

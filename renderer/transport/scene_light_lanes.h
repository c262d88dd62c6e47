// SPDX-License-Identifier: Apache-2.0
// Light samples of a scene's own sources (World::sources), for paths that are shaded in lanes.
#pragma once

#include <vector>

#include "transport/camera_samples.h"
#include "transport/vertex_arrays.h"

namespace chromeball {

// DirectLight::ofScene() for several vertices. The sources are sampled one vertex at a time; their
// samples are weighted in lanes, and the shadow rays form packets. Keeps its memory.
class SceneLightLanes {
 public:
  // Draws the samples of the first `count` vertices, of paths `ids` of the cameras at `depth`;
  // hidden ones have none.
  void draw(const World& world, const CameraSamples& cameras, std::span<const int32_t> ids,
            int depth, const VertexArrays& vertices, PathContext& context);
  bool isEmpty() const { return samples_.empty(); }

  // Adds the shadow rays of the vertices [i, i + 8). `throughput`: from the camera to them.
  void scatter(size_t i, const PlainBsdfLanes& bsdf, const Lanes3<Float8>& throughput, Mis mis,
               const VertexArrays& vertices, std::span<const int32_t> ids);

  // Adds the light that nothing blocks to the radiances, by id.
  void trace(const PathTracer& tracer, std::span<const uint32_t> keys, PathContext& context,
             std::span<Rgb> radiances);

 private:
  std::vector<DirectionSample> samples_;            // of all vertices
  std::array<size_t, kMostInArrays + 1> begins_{};  // of the samples of each vertex

  struct Shadow {
    int32_t id;
    uint32_t vertex;
    Rgb radiance;  // at the camera, if nothing is in the way
    LightEnd end;
  };
  std::vector<Shadow> shadows_;
  std::vector<Ray> rays_;  // theirs
  std::vector<Rgb> transmittances_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Light samples of a scene's own sources (World::sources), for paths that are shaded in lanes.
#pragma once

#include <vector>

#include "transport/guided_lanes.h"
#include "transport/path_arrays.h"
#include "transport/vertex_arrays.h"

namespace chromeball {

// DirectLight::ofScene() for several vertices. The sources are sampled one vertex at a time; their
// samples are weighted in lanes, and the shadow rays form packets. Keeps its memory.
class SceneLightLanes {
 public:
  void clear() { shadows_.clear(), rays_.clear(); }

  // Adds the shadow rays of the vertices [i, i + 8) of paths at `depth`, but of hidden ones.
  // `normal`: of the BSDF. `throughput`: from the camera to the vertices.
  void scatter(const LaneTask& task, const PathArrays& paths, int depth, size_t i,
               const VertexArrays& vertices, const GuidedBsdfLanes& bsdf,
               const Lanes3<Float8>& normal, const Lanes3<Float8>& throughput);

  // Adds the light that nothing blocks to the radiances, by id.
  void trace(const LaneTask& task, std::span<const uint32_t> keys);

 private:
  void draw(const LaneTask& task, const PathArrays& paths, int depth, size_t i,
            const VertexArrays& vertices, const Lanes3<Float8>& normal);

  std::vector<DirectionSample> samples_;                      // of eight vertices
  std::array<size_t, LanesOf<Float8>::kCount + 1> begins_{};  // of the samples of each

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

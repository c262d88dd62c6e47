// SPDX-License-Identifier: Apache-2.0
// Paths over plain surfaces (plain_surfaces.h), shaded in lanes. PathTracer, which follows one
// path, is the reference: both give the same estimates but for rounding.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "lighting/light_arrays.h"
#include "transport/integrator.h"
#include "transport/scene_light_lanes.h"
#include "transport/vertex_arrays.h"

namespace chromeball {

// All paths are at the same depth. Vertices that a path may pass without a bounce, that share their
// place with a lamp or that have other lobes are not for lanes: from there PathBatch follows the
// path.
class WidePaths {
 public:
  static constexpr size_t kMaxPaths = kMostInArrays;

  // Whether this is how the tracer's paths are followed: for a strategy whose samples do not depend
  // on the point, without a scene's suns, and with nothing else that watches or guides the paths.
  static bool serves(const PathTracer& tracer, const PathContext& context);

  // Follows the paths of camera rays, up to kMaxPaths, to their ends, or until PathBatch must go
  // on; `rest` then has the paths left() of them. `radiances`: of the paths so far, in the order of
  // the cameras.
  void follow(const CameraSamples& cameras, const PathTracer& tracer, PathContext& context,
              PathBatch& rest, std::span<Rgb> radiances);
  // The numbers of the paths in `rest`, in its order.
  std::span<const uint32_t> left() const { return left_; }

 private:
  // Paths that are still followed, without gaps.
  struct Paths {
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
    void add(const Paths& from, size_t i, const LanePacking& packing);
    // Removes the paths of each eight whose bits isGone(first, here) returns; `here`: the bits of
    // those that exist.
    template <class IsGone>
    void removeIf(const IsGone& isGone);
  };
  struct Task;

  void start(const Task& task);
  void traceRays(const Task& task);
  void traceLastRays(const Task& task);
  void endEscaped(const Task& task);
  void addEscaped(const Task& task);
  void endAtLimit(const Task& task);
  void leaveLanes(const Task& task);
  bool isFollowed(const Task& task, size_t path) const;
  bool isNotForLanes(const Task& task, size_t path) const;
  bool notesMirrored(const Task& task, size_t path) const;
  const PlainSurfaces::Part& partOf(const Task& task, size_t path) const;
  void handOver(const Task& task, size_t path);
  void fillVertices(const Task& task);
  void addEmission(const Task& task);
  void noteFirst(const Task& task);
  void drawNumbers(const Task& task);
  void scatter(const Task& task);
  void scatterLanes(const Task& task, size_t first);
  void recordSamples(size_t first, unsigned lit, const BsdfLanesValue& value,
                     const Lanes3<Float8>& normal);
  LightRecord recordOf(size_t escaped, const Rgb& found, float lightPdf) const;
  void traceShadowRays(const Task& task);
  void setKeys(const Task& task);

  int depth_ = 0;
  std::array<Paths, 2> buffers_;
  Paths* paths_ = &buffers_[0];  // at this depth, and those that go on
  Paths* next_ = &buffers_[1];
  Paths escaped_;
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

  std::array<Rgb, kMaxPaths> transmittances_;
  std::array<float, kMaxPaths> crossSections_;
  std::array<uint32_t, kMaxPaths> keys_;  // as PixelSampler::sampleKey()
  std::vector<uint32_t> left_;
};

}  // namespace chromeball

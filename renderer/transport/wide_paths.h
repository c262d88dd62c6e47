// SPDX-License-Identifier: Apache-2.0
// Paths over plain surfaces (plain_surfaces.h), shaded in lanes. PathTracer, which follows one
// path, is the reference: both give the same estimates but for rounding.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "transport/integrator.h"
#include "transport/scatter_lanes.h"

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
  void trace(const CameraSamples& cameras, const PathTracer& tracer, PathContext& context,
             PathBatch& rest, std::span<Rgb> radiances);
  // The numbers of the paths in `rest`, in its order.
  std::span<const uint32_t> left() const { return left_; }

 private:
  void start(const LaneTask& task);
  void follow(const LaneTask& task);
  void traceRays(const LaneTask& task);
  void traceLastRays(const LaneTask& task);
  void endEscaped(const LaneTask& task);
  void addEscaped(const LaneTask& task);
  void endAtLimit(const LaneTask& task);
  void leaveLanes(const LaneTask& task);
  bool isFollowed(const LaneTask& task, size_t path) const;
  bool isNotForLanes(const LaneTask& task, size_t path) const;
  bool notesMirrored(const LaneTask& task, size_t path) const;
  const PlainSurfaces::Part& partOf(const LaneTask& task, size_t path) const;
  void handOver(const LaneTask& task, size_t path);
  void leaveHidden(const LaneTask& task);
  bool isHidden(size_t path) const { return scatter_.vertices().isHidden[path] != 0; }
  void addEmission(const LaneTask& task);
  void noteFirst(const LaneTask& task);
  LightRecord recordOf(size_t escaped, const Rgb& found, float lightPdf) const;
  void setKeys(const LaneTask& task);

  int depth_ = 0;
  std::array<PathArrays, 2> buffers_;
  PathArrays* paths_ = &buffers_[0];  // at this depth, and those that go on
  PathArrays* next_ = &buffers_[1];
  PathArrays escaped_;
  ScatterLanes scatter_;
  LightArrays found_;  // by those that escaped
  GuidedPaths guided_;
  PathBatch* rest_ = nullptr;
  std::array<Rgb, kMaxPaths> transmittances_;
  std::array<uint32_t, kMaxPaths> keys_;  // as PixelSampler::sampleKey()
  std::vector<uint32_t> left_;
};

}  // namespace chromeball

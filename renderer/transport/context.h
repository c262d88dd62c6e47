// SPDX-License-Identifier: Apache-2.0
// The mutable state of one thread that traces paths.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "film/aov.h"
#include "guiding/caustic_guide.h"
#include "guiding/light_guide.h"
#include "lighting/light_source.h"
#include "math/sampler.h"
#include "math/vec.h"
#include "trace/ray.h"
#include "transport/depth_cut.h"

namespace chromeball {

// An optional upper bound on the radiance of a sample (`clamp`). The bias is measured and reported.

// Number of clamped samples, and the energy removed from them.
struct ClampedSamples {
  uint64_t count = 0;
  double removed = 0, kept = 0;  // sums over samples of (absolute) luminance

  void forgetLight() { removed = kept = 0; }
  double fractionRemoved() const { return removed > 0 ? removed / (removed + kept) : 0; }
  void add(const ClampedSamples& other) {
    count += other.count, removed += other.removed, kept += other.kept;
  }
};

class Clamp {
 public:
  explicit Clamp(std::optional<float> limit = {}) : limit_(limit) {}

  // The radiance (or difference of radiances) scaled so that no channel exceeds the limit in
  // absolute value; the hue stays. Non-finite values pass unchanged, to be counted as invalid.
  Rgb operator()(const Rgb& radiance) {
    if (!limit_ || !isFinite(radiance)) return radiance;
    const float largest = maxComponent(absolute(radiance));
    const float scale = largest > *limit_ ? *limit_ / largest : 1;
    const double light = std::fabs(double(luminance(radiance)));
    clamped_.kept += light * scale;
    if (scale == 1) return radiance;
    ++clamped_.count;
    clamped_.removed += light * (1 - double(scale));
    return radiance * scale;
  }

  const ClampedSamples& clamped() const { return clamped_; }
  ClampedSamples takeClamped() { return std::exchange(clamped_, {}); }

 private:
  std::optional<float> limit_;
  ClampedSamples clamped_;
};

class GroupSums;

struct RayCounts {
  uint64_t camera = 0, shadow = 0, bounce = 0;

  void add(const RayCounts& other) {
    camera += other.camera, shadow += other.shadow, bounce += other.bounce;
  }
};

// The rays that a thread traces, in order, for benchmarks that trace the same rays again.
struct RayLog {
  struct Entry {
    Ray ray;
    bool isShadow;
  };
  std::vector<Entry> rays;
};

// The first guided bounce of a path, for its record.
struct GuidedBounce {
  BounceRecord record{};  // lobesPdf 0: none
  Rgb before{0};          // radiance that the path had found up to the bounce
  bool isNew = false;

  // Called when the bounce's vertex is complete: light that the path finds from now on is found
  // behind it.
  void startRest(const Rgb& radiance) {
    if (isNew) before = radiance;
    isNew = false;
  }
};

// The records from which guides learn.
struct GuideRecords {
  bool wantsLights = true;
  std::vector<LightRecord> lights;
  std::vector<BounceRecord> bounces;
};

struct PathContext {
  PixelSampler sampler;                       // at the current sample
  std::vector<DirectionSample> lightSamples;  // scratch; keeps its capacity
  RayCounts counts;
  DepthCut depthCut;
  Clamp clamp;                      // integrators apply it to the radiance that they return
  GroupSums* groups = nullptr;      // output, of light_groups.h; null: not wanted
  std::vector<Rgb> lightRadiances;  // scratch of `groups`; keeps its capacity
  // Set if the transmittance of a shadow ray differs between PathSettings::visible and ::compared.
  bool shadowsDiffer = false;
  GuideRecords* records = nullptr;  // output; null: not wanted
  RayLog* log = nullptr;            // null: no log

  // `passed`: transmittance of the shadow ray.
  void addRecord(LightRecord record, const Rgb& passed = Rgb(1)) const {
    record.integrand *= luminance(passed);
    if (records->wantsLights && record.integrand > 0 &&
        std::isfinite(record.integrand / record.density))
      records->lights.push_back(record);
  }
  // Adds the record of a guided bounce at the end of its path.
  void addRecord(const GuidedBounce& bounce, const Rgb& radiance) const {
    if (!records || bounce.record.lobesPdf == 0 || bounce.isNew) return;  // new: the path has ended
    BounceRecord record = bounce.record;
    record.found = std::fabs(luminance(radiance - bounce.before));
    if (record.found > 0 && std::isfinite(record.found)) records->bounces.push_back(record);
  }
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Estimates the light at many points, on all threads.
#pragma once

#include "bake/point_light.h"
#include "base/progress.h"
#include "film/invalid.h"

namespace chromeball {

struct BakeSettings {
  BakedLight what = BakedLight::Irradiance;
  uint32_t samples = 256;  // of each point, >= 2
  uint64_t seed = 0;
  int maxDepth = 8;           // as PathSettings; 1: direct light
  float distance = INFINITY;  // of ambient occlusion, metres
};

struct PointResult {
  std::array<Rgb, 2> halves{};  // means of independent halves of the samples
  bool buried = false;          // inside a body: no light was estimated

  Rgb mean() const { return 0.5f * (halves[0] + halves[1]); }
};

struct BakeResult {
  std::vector<PointResult> points;  // as the points
  InvalidSamples invalid;           // at the points' x and y
  RayCounts rays;
};

// `meshes`: of all instances of the world. The result depends on points, samples and seed only.
BakeResult bake(const World& world, const LightSource& lighting,
                const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                const BakeSettings& settings, const Progress& progress);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Light of several sources: a probe's strategy, and what a scene has besides its probe.
#pragma once

#include <memory>
#include <vector>

#include "lighting/light_source.h"

namespace chromeball {

// Takes the samples of every part. Radiances and pdfs of all parts are added in each direction, so
// that all samples are combined by the balance heuristic (Veach 1997). It can be guided if the
// first part can.
class CombinedLight : public LightSource {
 public:
  // The first part is that of the probe.
  explicit CombinedLight(std::vector<std::unique_ptr<LightSource>> parts);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3& origin, const vec3& wi) const override;
  bool canBeGuided() const override { return parts_.front()->canBeGuided(); }
  bool sampleDistant(const glm::uvec2& numbers, DirectionSample& out) const override;
  float mirrorAlpha() const override { return parts_.front()->mirrorAlpha(); }
  bool unbiased() const override { return parts_.front()->unbiased(); }
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  std::vector<std::unique_ptr<LightSource>> parts_;
  std::vector<size_t> groupCounts_;  // of each part
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// `suns`: concentrated sources are replaced by discs that are sampled separately; the remainder of
// the probe is sampled as in `importance` (HDRI book, section 9.6.1).
#pragma once

#include <optional>

#include "lighting/importance.h"
#include "lighting/sky_discs.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// Takes one stratified sample of each sun, or of one of many (sky_discs.h), and one of the
// remainder. All rays, including those of the camera and mirrors, see the
// remainder plus the discs, so energy is counted once. The only bias is the shape of the suns,
// visible in highlights and penumbras: a disc with the irradiance and the spread of the source that
// it replaces (probe/sun_extraction.h). (At a pole the interpolation of the last row adds light to
// the probe; discs there have up to 8% less.)
//
// All samples are combined by the balance heuristic: pdfs and radiances of the remainder and all
// discs in a direction are added.
class Suns : public LightSource {
 public:
  // `compensated`: MIS compensation of the remainder (importance.h). `angle`: a diameter for all
  // suns, in degrees, above 0 and at most 90, instead of the measured ones; the Sun's is
  // kSunDiameter (probe/sky.h).
  Suns(const Probe& probe, bool compensated, std::optional<double> angle = {});
  Suns(const Suns&) = delete;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override;
  // Without suns this is `importance`.
  bool unbiased() const override { return discs_.empty(); }
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  Suns(SunExtraction extraction, const Rotation& rotation, bool compensated,
       std::optional<double> angle);

  Probe remainder_;
  Importance importance_;
  SkyDiscs discs_;
};

}  // namespace chromeball

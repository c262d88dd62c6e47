// SPDX-License-Identifier: Apache-2.0
// `suns`: concentrated sources sampled as discs of their own, the rest of the probe by importance
// (HDRI book, 9.6.1).
#pragma once

#include <optional>

#include "lighting/importance.h"
#include "math/cdf.h"
#include "math/frame.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// One stratified sample of each sun and one of the remainder. Of more than two suns one is chosen
// by power: with four, that takes 45% fewer rays to the same noise. The probe becomes the remainder
// plus discs for every ray, mirrors' and the camera's as well, so energy is counted once. The only
// bias is the shape of the suns, which highlights and penumbras show: each is a disc with the
// irradiance and the spread of what it stands for (probe/sun_extraction.h). (In the row of texels
// at a pole, where interpolation between texels adds light, discs have up to 8% less.)
//
// All samples are weighted together by the balance heuristic: in a direction that several of the
// techniques can find, pdf is the sum of theirs, and radiance that of remainder and discs.
class Suns : public LightingStrategy {
 public:
  // `compensated`: of the remainder's table (Importance). `angle`: diameter of all suns in degrees,
  // above 0 and at most 90, in place of the measured ones; kSunDiameter (probe/sky.h) is the true
  // Sun's.
  Suns(const Probe& probe, bool compensated, std::optional<double> angle = {});
  Suns(const Suns&) = delete;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override;
  // Where the probe has no suns there are no discs, and the probe is sampled as it is.
  bool unbiased() const override { return discs_.empty(); }

 private:
  // Discs are measured by chords: the one from the centre to wi has no rounding error to speak of
  // however small the disc, and its square is uniform over the disc's solid angle, pi chord^2.
  struct Disc {
    Frame frame;  // z: towards the centre
    float squaredChord;
    Rgb radiance;
    float pdf;  // of all samples of discs that are taken together, inside this one

    bool contains(const vec3& wi) const {
      const vec3 to = wi - frame.z;
      return glm::dot(to, to) <= squaredChord;
    }
    vec3 direction(float u, float v) const;
  };
  Suns(const SunExtraction& extraction, float rotationDegrees, bool compensated,
       std::optional<double> angle);

  Probe remainder_;
  Importance importance_;
  std::vector<Disc> discs_;
  std::optional<CdfRows> choice_;  // by power, where one is chosen
};

}  // namespace chromeball

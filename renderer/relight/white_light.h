// SPDX-License-Identifier: Apache-2.0
// Radiance 1 from everywhere, for the pass that renders a light stage.
#pragma once

#include "lighting/light_source.h"
#include "math/frame.h"
#include "math/warp.h"

namespace chromeball {

// Directions uniform over the hemisphere of the normal: all lighting conditions are equally likely.
// `samples` of them at the first hit, each of pdf 1 / 2 pi, as the points of a Hammersley set that
// is shifted at random; one at later hits. With one sample it is the strategy `uniform` of a
// constant probe.
class WhiteLight : public LightSource {
 public:
  explicit WhiteLight(int samples) : samples_(samples) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const int count = countAt(point);
    const vec2 shift = sampler.get2(dimension::kLight);
    const Frame frame(point.normal);
    for (int i = 0; i < count; ++i) {
      const vec2 u = shift + vec2(float(i) / float(count), radicalInverse(uint32_t(i)));
      const vec3 local = squareToUniformHemisphere(u - glm::floor(u));
      out.push_back({frame.toWorld(local), Rgb(2 * kPi / float(count)), pdf(count)});
    }
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return {Rgb(1), glm::dot(point.normal, wi) > 0 ? pdf(countAt(point)) : 0};
  }
  Rgb background(const vec3&, const vec3&) const override { return Rgb(1); }

 private:
  int countAt(const LightPoint& point) const { return point.depth == 0 ? samples_ : 1; }
  static float pdf(int count) { return float(count) * (0.5f * kInvPi); }
  // The bits behind the point in reverse order: van der Corput's sequence.
  static float radicalInverse(uint32_t i) {
    float result = 0;
    for (float digit = 0.5f; i > 0; i /= 2, digit /= 2)
      if (i % 2 == 1) result += digit;
    return result;
  }

  int samples_;
};

}  // namespace chromeball

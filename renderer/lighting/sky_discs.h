// SPDX-License-Identifier: Apache-2.0
// Distant discs of constant radiance, such as suns.
#pragma once

#include <optional>
#include <vector>

#include "base/hash.h"
#include "math/cdf.h"
#include "math/rotation.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// Samples one direction in each disc, uniform over its solid angle 2 pi (1 - cos(angle / 2)). Of
// more than two discs, chooses one with probability proportional to power: with four suns this
// needs 45% fewer rays for the same noise.
class SkyDiscs {
 public:
  // Turned, as a probe.
  explicit SkyDiscs(const std::vector<Sun>& suns, const Rotation& rotation = {});

  bool empty() const { return discs_.empty(); }

  // Calls visit(wi) for each direction. All discs use the same stratified point with different
  // digital shifts, which keep it stratified; `set` tells several lists of discs apart.
  template <class Visit>
  void sample(uint32_t u, uint32_t v, uint64_t set, const Visit& visit) const {
    if (choice_) {
      double position = (u ^ uint32_t(hash(set))) * 0x1p-32;
      const int chosen = choice_->sample(0, position);
      visit(discs_[size_t(chosen)].cap.direction(float(position),
                                                 toUnit(v ^ uint32_t(hash(set + 1)))));
      return;
    }
    for (size_t i = 0; i < discs_.size(); ++i) {
      const uint64_t shift = hash(set + i);
      visit(
          discs_[i].cap.direction(toUnit(u ^ uint32_t(shift)), toUnit(v ^ uint32_t(shift >> 32))));
    }
  }

  // Of all discs in a direction.
  struct Light {
    Rgb radiance{0};
    float pdf = 0;  // of sample(), over solid angle: the sum over its directions
  };
  Light at(const vec3& wi) const {
    Light light;
    forDiscsAt(wi, [&](size_t, const Light& disc) {
      light.radiance += disc.radiance;
      light.pdf += disc.pdf;
    });
    return light;
  }
  // Calls visit(index of the sun, its Light) for each disc in the direction.
  template <class Visit>
  void forDiscsAt(const vec3& wi, const Visit& visit) const {
    for (size_t i = 0; i < discs_.size(); ++i)
      if (discs_[i].cap.contains(wi)) visit(i, Light{discs_[i].radiance, discs_[i].pdf});
  }

 private:
  struct Disc {
    SphericalCap cap;
    Rgb radiance;
    float pdf;  // inside this disc
  };

  std::vector<Disc> discs_;
  std::optional<CdfRows> choice_;  // of one disc by power; empty if all are sampled
};

}  // namespace chromeball

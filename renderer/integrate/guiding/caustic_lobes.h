// SPDX-License-Identifier: Apache-2.0
// A density over the directions from which caustics light a small region.
#pragma once

#include <span>
#include <vector>

#include "base/archive.h"
#include "integrate/guiding/photon.h"

namespace chromeball {

// A mixture of lobes around the images of lights in mirrors and lenses. Seen from a point of the
// region, an image lies in a direction a(x); a quadtree would blur it over all the directions that
// it takes within the region (Ruppert, Herholz, Lensch 2020, "Robust Fitting of Parallax-Aware
// Mixtures for Path Tracing"). Here a(x) is linear in x, fitted to photons by least squares, which
// follows astigmatic images too, whose rays do not meet in a point. The density of a lobe of
// spread s at the angle theta from its axis is
//   s (2 + s) / (4 pi (1 - cos(theta) + s)^2).
class CausticLobes {
 public:
  CausticLobes() = default;
  // Lights are told apart by chain, and by the region of the probe. Reorders the photons.
  explicit CausticLobes(std::span<Photon> photons);

  bool empty() const { return upTo_.empty(); }
  size_t count() const { return upTo_.size(); }

  struct Sample {
    vec3 direction;  // unit
    float pdf;       // over solid angle
  };
  Sample sample(const vec3& position, vec2 u, float lobe) const;
  float pdf(const vec3& position, const vec3& direction) const;  // over solid angle

  void archive(Archive& a) {
    a(origin_);
    a(upTo_);
    a(packs_);
    a.check(upTo_.size() <= packs_.size() * Pack::kLobes);
  }

 private:
  struct Lobe {
    glm::dvec3 axis;      // at the origin of the region; not unit
    glm::dmat3 gradient;  // of the axis
    double spread, flux;
  };
  // Lobes whose densities are calculated together. The axis is base + gradient x, made unit.
  struct Pack {
    static constexpr size_t kLobes = 8;
    alignas(32) float base[3][kLobes]{};
    float gradient[3][3][kLobes]{};  // by column, row
    float spread[kLobes]{};
    float factor[kLobes]{};  // of the density, with the lobe's probability
  };
  void divide(std::span<Photon> photons, vec2 corner, float size, double total,
              std::vector<Lobe>& lobes) const;
  Lobe fit(std::span<const Photon> photons) const;

  vec3 origin_{0};
  std::vector<float> upTo_;  // sum of the probabilities up to each lobe
  std::vector<Pack> packs_;
};

}  // namespace chromeball

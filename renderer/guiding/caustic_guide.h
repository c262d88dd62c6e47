// SPDX-License-Identifier: Apache-2.0
// Guided bounces: directions from which mirrors, metals and glass throw the probe's light onto
// rough surfaces, learned from photons. No light sample finds such light, and bounces find it by
// chance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/archive.h"
#include "guiding/region_tree.h"
#include "math/vec.h"

namespace chromeball {

// Light of the probe and of lamps that mirrors, metals and glass throw onto rough surfaces: paths
// from the light (Jensen 1996, "Global Illumination using Photon Maps").

// A bounce with a larger pdf, over solid angle, belongs to a narrow lobe. (A diffuse bounce has
// 1 / pi at most, a GGX lobe of roughness 0.45 has 2.)
inline constexpr float kConcentratedPdf = 2;

// The arrival of such a path at a rough surface.
struct Photon {
  vec3 position, normal;
  vec3 direction;  // unit, towards the last surface that reflected or refracted the light
  vec3 emission;   // unit, towards the light on the probe; the same for all light of lamps
  uint32_t chain;  // a hash of the lamp and of the instances that the path met, in order
  float flux;      // luminance
};

// A density over the directions from which caustics light a small region.

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

// Light that was found behind a bounce where the guide has lobes.
struct BounceRecord {
  float found;              // |luminance| that the path added to its pixel's sample
  float lobesPdf, bsdfPdf;  // of the bounce
  float fraction;           // of such bounces that came from the lobes
};

class CausticGuide {
 public:
  CausticGuide() = default;
  explicit CausticGuide(std::vector<Photon> photons);

  // Whether nothing is guided: find() returns null everywhere.
  bool empty() const { return tree_.empty(); }
  // Null where there are no caustics.
  const CausticLobes* find(const vec3& position, const vec3& normal) const {
    if (empty()) return nullptr;
    const CausticLobes& region = regions_[tree_.find(position, normal)];
    return region.empty() ? nullptr : &region;
  }

  // The fraction of bounces in regions with lobes that take their direction from the lobes.
  float fraction() const { return fraction_; }
  static constexpr float kTrainingFraction = 0.25f;
  void setFraction(float fraction) { fraction_ = fraction; }

  void archive(Archive& a) {
    a(regions_);
    tree_.archive(a, regions_.size());
    a(fraction_);
    a.check(fraction_ >= 0 && fraction_ < 1);
  }

 private:
  RegionTree tree_;
  std::vector<CausticLobes> regions_;
  float fraction_ = kTrainingFraction;
};

}  // namespace chromeball

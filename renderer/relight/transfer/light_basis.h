// SPDX-License-Identifier: Apache-2.0
// The functions on the sphere of which the light of transfer is a weighted sum: spherical
// harmonics, or Haar wavelets on the faces of a cube (HDRI book, section 9.9.2).
#pragma once

#include "relight/stage/light_stage.h"
#include "relight/stage/relight.h"

namespace chromeball {

// What light with coefficients l makes is the sum of l_k t_k, where t_k is what light of the
// function k alone makes: transfer (Sloan, Kautz and Snyder 2002; Ng, Ramamoorthi and Hanrahan
// 2003).
//
// sh:ORDER  the real spherical harmonics up to this order; l_k is the integral of radiance x Y_k.
// haar:N    Haar wavelets of a cube map of N x N cells on each face, face by face. l is the
//           orthonormal transform (haar.h) of the cells' mean radiances. The transform keeps
//           scalar products, so t is that of what each cell makes with radiance 1.
class LightBasis {
 public:
  static constexpr int kMaxOrder = 6, kMaxCells = 32;

  // Throws InputError, begun by `location`.
  LightBasis(const std::string& name, const std::string& location);

  const std::string& name() const { return name_; }
  bool isHaar() const { return domain_ == RelightDomain::Haar; }
  size_t size() const { return size_t(directions_.size()); }  // the number of functions

  // Transfer is summed up in two steps: a sample that finds the light of `direction` (unit) with
  // `weight`, then, for the sum of all samples, its coefficients in place.
  void add(const vec3& direction, const dvec3& weight, std::span<dvec3> sums) const {
    directions_.forValues(direction,
                          [&](int k, float value) { sums[size_t(k)] += double(value) * weight; });
  }
  void transform(std::span<Rgb> sums) const { chromeball::transform(sums, directions_, domain_); }

  // l of a probe that is turned by `rotation`.
  std::vector<Rgb> project(const Image& latLong, const Rotation& rotation) const;

  // The share of a face that a wavelet covers; 1 for harmonics.
  double support(size_t function) const;

 private:
  std::string name_;
  DirectionBasis directions_;
  RelightDomain domain_;
};

// Sets all but the `keep` most important coefficients to 0. The importance of a coefficient is
// the length of its RGB times its support: Ng et al. 2003 (section 4.2) call this the
// area-weighted choice.
void keepMostImportant(const LightBasis& basis, size_t keep, std::span<Rgb> light);

}  // namespace chromeball

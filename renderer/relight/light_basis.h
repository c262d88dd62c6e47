// SPDX-License-Identifier: Apache-2.0
// Functions on the sphere of which light is a weighted sum (HDRI book, section 9.9.1): spherical
// harmonics, or Haar wavelets on the faces of a cube.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

// What light with coefficients l makes is sum of l_k t_k, where t_k is what light of the function k
// alone makes: transfer (Sloan, Kautz and Snyder 2002; Ng, Ramamoorthi and Hanrahan 2003).
//
// sh:ORDER  the real spherical harmonics up to this order; l_k is the integral of radiance x Y_k.
// haar:N    Haar wavelets of a cube map of N x N cells on each face; face by face. l is the
//           orthonormal transform (haar.h) of the cells' mean radiances. The transform keeps
//           scalar products, so t is that of what each cell makes with radiance 1.
class LightBasis {
 public:
  enum class Kind { Harmonics, Haar };
  static constexpr int kMaxOrder = 6, kMaxCells = 32;

  // `number`: ORDER or N.
  LightBasis(Kind kind, int number) : kind_(kind), number_(number) {}
  // "sh:4", "haar:16". Throws InputError, begun by `location`.
  static LightBasis parse(std::string_view text, std::string_view location);

  Kind kind() const { return kind_; }
  int order() const { return number_; }  // of harmonics
  size_t size() const;                   // the number of functions
  std::string name() const;

  // Transfer is summed up in two steps: a sample that finds the light of `direction` (unit) with
  // `weight`, then, for the sum of all samples, its coefficients in place.
  void add(const vec3& direction, const dvec3& weight, std::span<dvec3> sums) const;
  void transform(std::span<dvec3> sums) const;

  // l of a probe, constant over each texel, that is turned by `rotation`.
  std::vector<dvec3> project(const Image& latLong, const Rotation& rotation) const;

  // How much of the sphere a function covers, relative to that which covers most.
  double support(size_t function) const;

 private:
  size_t cellOf(const vec3& direction) const;
  std::vector<dvec3> cellMeans(const Image& latLong, const Rotation& rotation) const;

  Kind kind_;
  int number_;
};

// Sets all but the `keep` most important coefficients to 0. The importance of a coefficient is
// the length of its RGB times its support: Ng et al. 2003 (section 4.2) call this the
// area-weighted choice.
void keepLargest(const LightBasis& basis, size_t keep, std::span<dvec3> light);

}  // namespace chromeball

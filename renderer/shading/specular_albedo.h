// SPDX-License-Identifier: Apache-2.0
// Directional albedo of GGX microfacets in one bounce.
#pragma once

namespace chromeball {

// Under Schlick's Fresnel term F0 + (F90 - F0)(1 - cos)^5 the albedo is linear in F0 and F90:
//   E(mu) = F0 a(mu) + F90 b(mu),   mu the cosine of the viewing angle.
// With F0 = F90 = 1 it is below 1 by the light that microfacets scatter more than once.
struct SpecularAlbedo {
  float a, b;

  float white() const { return a + b; }  // with F0 = F90 = 1

  SpecularAlbedo& operator+=(const SpecularAlbedo& other) {
    a += other.a, b += other.b;
    return *this;
  }
  friend SpecularAlbedo operator*(float factor, const SpecularAlbedo& s) {
    return {factor * s.a, factor * s.b};
  }
  friend SpecularAlbedo mix(const SpecularAlbedo& x, const SpecularAlbedo& y, float t) {
    return {x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
  }
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The BSDFs of plain materials at eight points at once: one for each lane. lambert.h and
// metallic_roughness.h, for one point, explain the models, and are what tests compare these with.
// They have the broad lobes and smooth mirrors, as strategies without a mirrorAlpha() need them.
#pragma once

#include <optional>

#include "math/lanes.h"
#include "scene/material.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

struct BsdfLanesValue {
  Lanes3<Float8> fCos;
  Float8 pdf;
};

struct BsdfLanesSample {
  Lanes3<Float8> wi, weight;
  Float8 pdf;    // over solid angle; 0 for a smooth mirror
  Int8 isValid;  // the light is not absorbed
};

// As Frame.
struct LanesFrame {
  Lanes3<Float8> x, y, z;

  explicit LanesFrame(const Lanes3<Float8>& normal) : z(normal) {
    const Float8 sign = LanesOf<Float8>::withSignOf(LanesOf<Float8>::splat(1), z.z);
    const Float8 a = -1 / (sign + z.z), b = z.x * z.y * a;
    x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
    y = {b, sign + z.y * z.y * a, -z.y};
  }
  Lanes3<Float8> toLocal(const Lanes3<Float8>& v) const {
    return {dot(v, x), dot(v, y), dot(v, z)};
  }
  Lanes3<Float8> toWorld(const Lanes3<Float8>& v) const { return v.x * x + v.y * y + v.z * z; }
};

class LambertLanes {
 public:
  LambertLanes(const Lanes3<Float8>& albedo, const Lanes3<Float8>& normal,
               const Lanes3<Float8>& geometricNormal)
      : albedo_(albedo), geometricNormal_(geometricNormal), frame_(normal) {}

  BsdfLanesValue evaluate(const Lanes3<Float8>& wi) const;
  BsdfLanesSample sample(Float8 u, Float8 v) const;
  const Lanes3<Float8>& normal() const { return frame_.z; }

 private:
  Lanes3<Float8> albedo_, geometricNormal_;
  LanesFrame frame_;
};

// MaterialPoint in lanes.
struct MaterialLanes {
  Lanes3<Float8> baseColor;
  Float8 metallic, roughness;
  Lanes3<Float8> dielectricF0;
  Float8 dielectricF90;
};

class MetallicRoughnessLanes {
 public:
  // Unit vectors, as those of MetallicRoughness.
  MetallicRoughnessLanes(const MaterialLanes& material, const Lanes3<Float8>& normal,
                         const Lanes3<Float8>& geometricNormal, const Lanes3<Float8>& wo,
                         const EnergyTable& table);

  BsdfLanesValue evaluate(const Lanes3<Float8>& wi) const;
  BsdfLanesSample sample(Float8 u, Float8 v, Float8 lobe) const;
  const Lanes3<Float8>& normal() const { return frame_.z; }
  Int8 hasBroad() const { return ~isSmooth_ | (specularProbability_ < 1); }

 private:
  struct Albedo {  // SpecularAlbedo
    Float8 a, b;
  };
  // Rows of the table, between which the points' roughnesses lie.
  struct Rows {
    const EnergyTable& table;
    Int8 row;
    Float8 blend;

    Rows(const EnergyTable& energy, Float8 roughness);
    Albedo at(Float8 mu) const;
    Albedo average() const;
  };
  Float8 dielectricAlbedo(const Albedo& s) const {
    return dielectricF0_ * s.a + dielectricF90_ * s.b + dielectricMultiple_ * (1 - s.a - s.b);
  }
  Lanes3<Float8> schlick(Float8 cosine) const;
  BsdfLanesValue evaluateLocal(const Lanes3<Float8>& wi) const;
  Lanes3<Float8> visibleNormal(Float8 u, Float8 v) const;

  Rows energy_;
  Lanes3<Float8> geometricNormal_;
  LanesFrame frame_;
  Lanes3<Float8> wo_;  // in the frame
  Float8 alpha_;
  Int8 isSmooth_;
  Lanes3<Float8> f0_;
  Float8 f90_;
  Float8 dielectricF0_, dielectricF90_, dielectricMultiple_;
  Lanes3<Float8> diffuse_, multiple_;
  Float8 specularProbability_;
};

// The BSDF of plain materials: Lambert's where a material has no specular reflection, as Bsdf. A
// lane's results do not depend on the other lanes.
class PlainBsdfLanes {
 public:
  // The table may be null if all are Lambertian, and must outlive this.
  PlainBsdfLanes(const MaterialLanes& material, const Lanes3<Float8>& normal,
                 const Lanes3<Float8>& geometricNormal, const Lanes3<Float8>& wo,
                 const EnergyTable* table);

  BsdfLanesValue evaluate(const Lanes3<Float8>& wi) const;
  BsdfLanesSample sample(Float8 u, Float8 v, Float8 lobe) const;
  Lanes3<Float8> normal() const;
  Int8 hasBroad() const;  // as Bsdf::has()

 private:
  Int8 isLambertian_;
  LambertLanes lambert_;
  std::optional<MetallicRoughnessLanes> metallicRoughness_;  // unless all are Lambertian
};

}  // namespace chromeball

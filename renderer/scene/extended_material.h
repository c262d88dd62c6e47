// SPDX-License-Identifier: Apache-2.0
// What the glTF material extensions add to metallic-roughness. A plain material has none of it.
#pragma once

#include "scene/texture.h"

namespace chromeball {

struct ExtendedMaterial {
  // KHR_materials_transmission, _volume and _dispersion
  float transmission = 0;  // share of the dielectric's base that lets light through
  bool thinWalled = true;  // a sheet; else the mesh is the boundary of a body, and refracts
  Rgb attenuation{0};      // in the body, 1/m: a share exp(-attenuation s) passes s metres
  float dispersion = 0;    // 20 / Abbe number
  TextureSlot transmissionTexture;  // R

  // KHR_materials_clearcoat: a dielectric layer of index 1.5 on top of all else
  float clearcoat = 0, clearcoatRoughness = 0, clearcoatNormalScale = 1;
  TextureSlot clearcoatTexture;           // R
  TextureSlot clearcoatRoughnessTexture;  // G
  TextureSlot clearcoatNormalTexture;

  // KHR_materials_sheen
  Rgb sheenColor{0};
  float sheenRoughness = 0;
  TextureSlot sheenColorTexture;      // sRGB
  TextureSlot sheenRoughnessTexture;  // A

  // KHR_materials_anisotropy
  float anisotropy = 0, anisotropyRotation = 0;  // strength; radians from the tangent, ccw
  TextureSlot anisotropyTexture;                 // RG direction, B strength

  // KHR_materials_iridescence: a film, nanometres thick
  float iridescence = 0, filmIor = 1.3f, filmThinnest = 100, filmThickest = 400;
  TextureSlot iridescenceTexture;    // R
  TextureSlot filmThicknessTexture;  // G, from thinnest to thickest; without it, the thickest
};

}  // namespace chromeball

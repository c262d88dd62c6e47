// SPDX-License-Identifier: Apache-2.0
// Parameters of the glTF material extensions. A plain metallic-roughness material has none of them.
#pragma once

#include "scene/texture.h"

namespace chromeball {

struct ExtendedMaterial {
  // KHR_materials_transmission, _volume and _dispersion
  float transmission = 0;  // fraction of the dielectric base that transmits instead of scattering
  bool thinWalled = true;  // a thin sheet; if false, the mesh bounds a body and refracts
  Rgb attenuation{0};      // in the body, 1/m: transmittance over s metres is exp(-attenuation s)
  float dispersion = 0;    // 20 / Abbe number
  TextureSlot transmissionTexture;  // R

  // KHR_materials_clearcoat: a dielectric layer of index 1.5 on top of all other layers
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
  float anisotropy = 0,
        anisotropyRotation = 0;   // strength; radians from the tangent, counter-clockwise
  TextureSlot anisotropyTexture;  // RG direction, B strength

  // KHR_materials_iridescence: a thin film; thickness in nanometres
  float iridescence = 0, filmIor = 1.3f, filmMinThickness = 100, filmMaxThickness = 400;
  TextureSlot iridescenceTexture;    // R
  TextureSlot filmThicknessTexture;  // G, from minimum to maximum; without it, the maximum
};

}  // namespace chromeball

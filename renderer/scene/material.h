// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 metallic-roughness material, as the file states it.
#pragma once

#include <optional>
#include <string>

#include "scene/extended_material.h"
#include "scene/texture.h"

namespace chromeball {

class Projection;

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

// What single-sided surfaces are not there for: the camera and mirrors behind them, as back-face
// culling has it (glTF 2.0, 3.9.6); the light that comes from behind as well; or nothing.
enum class SingleSided : uint8_t { Camera, Light, Off };

struct Material {
  std::string name;
  vec4 baseColor{1};                  // linear RGB and alpha; times texture, times vertex colour
  float metallic = 1, roughness = 1;  // perceptual roughness; alpha of GGX is its square
  Rgb emission{0};                    // emissiveFactor * emissiveStrength, radiance
  float ior = 1.5f;                   // KHR_materials_ior; 0 means infinite (F0 = 1)
  float specular = 1;                 // KHR_materials_specular: weight of the dielectric lobe
  Rgb specularColor{1};
  float normalScale = 1;
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  SingleSided singleSided = SingleSided::Camera;  // where not doubleSided
  bool unlit = false;  // KHR_materials_unlit: emits its base colour, reflects nothing

  // Whether the camera and mirrors do not see it from behind; and whether light from there passes.
  bool hidesBack() const {
    return !doubleSided && singleSided != SingleSided::Off &&
           !(extended && extended->transmission > 0);
  }
  bool backLetsLightThrough() const { return hidesBack() && singleSided == SingleSided::Light; }

  // Whether it is the boundary of a body that light passes (KHR_materials_volume).
  bool isBody() const { return extended && extended->transmission > 0 && !extended->thinWalled; }

  // Gives the base colour where it sees the surface; null: none does.
  const Projection* projection = nullptr;

  bool emits() const { return unlit || emission != Rgb(0); }

  TextureSlot baseColorTexture;          // sRGB
  TextureSlot metallicRoughnessTexture;  // G roughness, B metallic
  TextureSlot normalTexture;
  TextureSlot emissiveTexture;       // sRGB
  TextureSlot specularTexture;       // A
  TextureSlot specularColorTexture;  // sRGB

  std::optional<ExtendedMaterial> extended;
};

// Every slot of a material, for what treats them alike.
std::vector<TextureSlot*> textureSlots(Material& m);

// The slot whose coordinates the tangents follow, where the material needs tangents at all.
std::optional<TextureSlot> tangentSpace(const Material& m);

}  // namespace chromeball

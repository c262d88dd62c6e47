// SPDX-License-Identifier: Apache-2.0
// A glTF 2.0 metallic-roughness material with the values of the file.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "scene/texture.h"

namespace chromeball {

// Parameters of the glTF material extensions. A plain metallic-roughness material has none of them.

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

class Projection;

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

// Which rays ignore the back faces of single-sided surfaces (glTF 2.0, 3.9.6). Camera: camera rays
// and mirror reflections (back-face culling). Light: also light from behind. Off: none.
enum class SingleSided : uint8_t { Camera, Light, Off };

// GGX widths below this one count as 0: a highlight would be 50 times narrower than the sun.
inline constexpr float kSmoothAlpha = 1e-4f;
// |ior - 1| below which light passes straight through a boundary.
inline constexpr float kMinRefraction = 1e-3f;

// Made, copied and destroyed in material.cpp, to be compiled once.
struct Material {
  Material();
  Material(const Material&);
  Material(Material&&) noexcept;
  Material& operator=(const Material&);
  Material& operator=(Material&&) noexcept;
  ~Material();

  std::string name;
  vec4 baseColor{1};                  // linear RGB and alpha; times texture, times vertex colour
  float metallic = 1, roughness = 1;  // perceptual roughness; GGX alpha = roughness^2
  Rgb emission{0};                    // emissiveFactor * emissiveStrength, radiance
  float ior = 1.5f;                   // KHR_materials_ior; 0 means infinite (F0 = 1)
  float specular = 1;                 // KHR_materials_specular: weight of the dielectric lobe
  Rgb specularColor{1};
  // KHR_materials_pbrSpecularGlossiness: the base colour is diffuse, and is reduced by the specular
  // colour, F0 (with an infinite index); the alpha of its texture times 1 - roughness is the
  // glossiness.
  bool specularGlossiness = false;
  float normalScale = 1;
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  SingleSided singleSided = SingleSided::Camera;  // ignored if doubleSided
  bool unlit = false;  // KHR_materials_unlit: emits its base colour, reflects nothing
  // Shadow rays pass the smooth body without refraction (extended_surface.h).
  bool straightShadows = false;

  // Whether the back is invisible to the camera and mirrors.
  bool hidesBack() const {
    return !doubleSided && singleSided != SingleSided::Off &&
           !(extended && extended->transmission > 0);
  }
  // Whether light from behind passes the surface.
  bool backLetsLightThrough() const { return hidesBack() && singleSided == SingleSided::Light; }

  // Whether a texture raises the roughness at some points.
  bool hasRoughnessTexture() const {
    return metallicRoughnessTexture || (specularGlossiness && specularColorTexture);
  }

  // Whether the surface is a perfect mirror, or transmits like clear glass, wherever a texture does
  // not make it rougher.
  bool isSmooth() const { return roughness * roughness < kSmoothAlpha; }

  // Whether rays may pass the surface, refracted or not.
  bool transmits() const { return extended && extended->transmission > 0; }

  // Whether the surface is the boundary of a transparent body (KHR_materials_volume).
  bool isBody() const { return extended && extended->transmission > 0 && !extended->thinWalled; }

  // Whether light passes in a single direction, which light samples cannot find.
  bool transmitsSharply() const {
    return transmits() && (isSmooth() || (isBody() && std::fabs(ior - 1) < kMinRefraction));
  }

  // Replaces the base colour where the surface is visible to the projector; null: none.
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

// All texture slots of a material.
std::vector<TextureSlot*> textureSlots(Material& m);

// The slot whose UV coordinates define the tangents; nullopt if the material needs no tangents.
std::optional<TextureSlot> tangentSpace(const Material& m);

}  // namespace chromeball

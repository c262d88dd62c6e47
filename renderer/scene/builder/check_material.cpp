// SPDX-License-Identifier: Apache-2.0
#include "scene/builder/check_material.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace chromeball {
namespace {

constexpr float kAny = 1e6f, kMost = std::numeric_limits<float>::max();

class MaterialCheck {
 public:
  explicit MaterialCheck(const Material& material) : material_(material) {}

  void number(const char* name, float x, float low, float high) const {
    if (!(x >= low && x <= high))
      throwInput("material \"{}\": {} is {:g}; it must be {:g} to {:g}", material_.name, name, x,
                 low, high);
  }
  void color(const char* name, const Rgb& c, float high) const {
    for (int k = 0; k < 3; ++k) number(name, c[k], 0, high);
  }

 private:
  const Material& material_;
};

void checkExtended(const MaterialCheck& check, const ExtendedMaterial& m) {
  check.number("transmission", m.transmission, 0, 1);
  check.color("attenuation", m.attenuation, kMost);
  check.number("dispersion", m.dispersion, 0, 1e3f);
  check.number("clearcoat", m.clearcoat, 0, 1);
  check.number("clearcoatRoughness", m.clearcoatRoughness, 0, 1);
  check.number("clearcoatNormalScale", m.clearcoatNormalScale, -kAny, kAny);
  check.color("sheenColor", m.sheenColor, 1);
  check.number("sheenRoughness", m.sheenRoughness, 0, 1);
  check.number("anisotropy", m.anisotropy, 0, 1);
  check.number("anisotropyRotation", m.anisotropyRotation, -kAny, kAny);
  check.number("iridescence", m.iridescence, 0, 1);
  check.number("filmIor", m.filmIor, 1, 1e3f);
  check.number("filmMinThickness", m.filmMinThickness, 0, kAny);
  check.number("filmMaxThickness", m.filmMaxThickness, 0, kAny);
}

void checkSlots(const Material& material, size_t textures) {
  constexpr int kMaxUvSet = 15;
  Material copy = material;  // textureSlots() allows changes
  for (const TextureSlot* slot : textureSlots(copy)) {
    if (!*slot) continue;
    if (size_t(slot->texture) >= textures)
      throwInput("material \"{}\": there is no texture {} among {}", material.name, slot->texture,
                 textures);
    if (slot->uvSet < 0 || slot->uvSet > kMaxUvSet)
      throwInput("material \"{}\": uvSet {} of a texture must be 0 to {}", material.name,
                 slot->uvSet, kMaxUvSet);
    for (const vec2& v : {slot->uvRow0, slot->uvRow1, slot->uvOffset})
      if (!std::isfinite(v.x + v.y))
        throwInput("material \"{}\": the transform of a texture is not finite", material.name);
  }
}

}  // namespace

void checkMaterial(const Material& m, size_t textures) {
  const MaterialCheck check(m);
  check.color("baseColor", Rgb(m.baseColor), 1);
  check.number("alpha of baseColor", m.baseColor.w, 0, 1);
  check.number("metallic", m.metallic, 0, 1);
  check.number("roughness", m.roughness, 0, 1);
  check.color("emission", m.emission, kMost);
  if (m.ior != 0) check.number("ior", m.ior, 1, kAny);
  check.number("specular", m.specular, 0, 1);
  check.color("specularColor", m.specularColor, kMost);
  check.number("normalScale", m.normalScale, -kAny, kAny);
  check.number("alphaCutoff", m.alphaCutoff, 0, kAny);
  if (m.extended) checkExtended(check, *m.extended);
  checkSlots(m, textures);
}

}  // namespace chromeball

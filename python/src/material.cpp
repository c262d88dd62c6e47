// SPDX-License-Identifier: Apache-2.0
#include "material.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <functional>

#include "arrays.h"
#include "base/error.h"
#include "base/text.h"
#include "values.h"

namespace chromeball::python {
namespace {

// A keyword and the member that it sets.
struct Field {
  std::string_view keyword;
  std::function<void(Material&, nb::handle, SceneBuilder&)> set;
};

[[noreturn]] void refuse(std::string_view keyword, std::string_view expected) {
  throwInput("Material(): {} should be {}", keyword, expected);
}

float numberOf(std::string_view keyword, nb::handle value) {
  float number = 0;
  if (!nb::try_cast(value, number)) refuse(keyword, "a number");
  return number;
}

std::string stringOf(std::string_view keyword, nb::handle value) {
  if (!nb::isinstance<nb::str>(value)) refuse(keyword, "a string");
  return textOf(value, fmt::format("Material(): {}", keyword));
}

// `count`: 3, or 4 with an alpha that may be missing.
vec4 colorOf(std::string_view keyword, nb::handle value, size_t count) {
  vec4 color(1);
  float grey = 0;
  if (nb::try_cast(value, grey)) return {vec3(grey), 1};
  nb::sequence channels;
  if (!nb::try_cast(value, channels) || (nb::len(channels) != 3 && nb::len(channels) != count))
    refuse(keyword, count == 4 ? "a number, or three or four" : "a number, or three");
  for (size_t i = 0; i < nb::len(channels); ++i)
    if (!nb::try_cast(channels[i], color[int(i)])) refuse(keyword, "made of numbers");
  return color;
}

TexelGrid gridOf(std::string_view keyword, nb::handle value) {
  TexelGrid grid;
  const auto take = [&](const auto& array, auto& texels) {
    grid.height = int(array.shape(0)), grid.width = int(array.shape(1));
    texels.resize(size_t(grid.width) * size_t(grid.height));
    std::copy_n(array.data(), array.size(), &texels[0][0]);
  };
  ArrayIn<uint8_t> bytes;
  ArrayIn<float> floats;
  if (nb::try_cast(value, bytes, false))
    take(bytes, grid.texels8);
  else if (nb::try_cast(value, floats, false))
    take(floats, grid.texelsFloat);
  else
    refuse(keyword, "an array of bytes or floats");
  return grid;
}

Field number(std::string_view keyword, float Material::*member) {
  return {keyword,
          [=](Material& m, nb::handle v, SceneBuilder&) { m.*member = numberOf(keyword, v); }};
}
Field number(std::string_view keyword, float ExtendedMaterial::*member) {
  return {keyword, [=](Material& m, nb::handle v, SceneBuilder&) {
            if (!m.extended) m.extended.emplace();
            *m.extended.*member = numberOf(keyword, v);
          }};
}
Field color(std::string_view keyword, Rgb Material::*member) {
  return {keyword, [=](Material& m, nb::handle v, SceneBuilder&) {
            m.*member = Rgb(colorOf(keyword, v, 3));
          }};
}
Field color(std::string_view keyword, Rgb ExtendedMaterial::*member) {
  return {keyword, [=](Material& m, nb::handle v, SceneBuilder&) {
            if (!m.extended) m.extended.emplace();
            *m.extended.*member = Rgb(colorOf(keyword, v, 3));
          }};
}
Field flag(std::string_view keyword, bool Material::*member) {
  return {keyword, [=](Material& m, nb::handle v, SceneBuilder&) {
            if (!PyBool_Check(v.ptr())) refuse(keyword, "True or False");
            m.*member = v.is(nb::handle(Py_True));
          }};
}
// Bytes of colours are encoded in sRGB.
Field texture(std::string_view keyword, TextureSlot Material::*member, bool isColor) {
  return {keyword, [=](Material& m, nb::handle v, SceneBuilder& builder) {
            TexelGrid grid = gridOf(keyword, v);
            const bool srgb = isColor && !grid.texels8.empty();
            m.*member = builder.addTexture(builder.addImage(std::move(grid)), srgb);
          }};
}

void setAlphaMode(Material& m, nb::handle value, SceneBuilder&) {
  static const std::vector<std::string_view> names = {"opaque", "mask", "blend"};
  const std::string name = stringOf("alpha_mode", value);
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throwInput("Material(): alpha_mode: `{}` is unknown; {}", name, didYouMean(name, names));
  m.alphaMode = AlphaMode(found - names.begin());
}

const std::vector<Field>& fields() {
  using E = ExtendedMaterial;
  static const std::vector<Field> all = {
      {"name", [](Material& m, nb::handle v, SceneBuilder&) { m.name = stringOf("name", v); }},
      {"base_color",
       [](Material& m, nb::handle v, SceneBuilder&) { m.baseColor = colorOf("base_color", v, 4); }},
      number("metallic", &Material::metallic),
      number("roughness", &Material::roughness),
      color("emission", &Material::emission),
      number("ior", &Material::ior),
      number("specular", &Material::specular),
      color("specular_color", &Material::specularColor),
      number("normal_scale", &Material::normalScale),
      {"alpha_mode", setAlphaMode},
      number("alpha_cutoff", &Material::alphaCutoff),
      flag("double_sided", &Material::doubleSided),
      flag("unlit", &Material::unlit),
      number("transmission", &E::transmission),
      {"thin_walled",
       [](Material& m, nb::handle v, SceneBuilder&) {
         if (!PyBool_Check(v.ptr())) refuse("thin_walled", "True or False");
         if (!m.extended) m.extended.emplace();
         m.extended->thinWalled = v.is(nb::handle(Py_True));
       }},
      color("attenuation", &E::attenuation),
      number("dispersion", &E::dispersion),
      number("clearcoat", &E::clearcoat),
      number("clearcoat_roughness", &E::clearcoatRoughness),
      color("sheen_color", &E::sheenColor),
      number("sheen_roughness", &E::sheenRoughness),
      number("anisotropy", &E::anisotropy),
      number("anisotropy_rotation", &E::anisotropyRotation),
      number("iridescence", &E::iridescence),
      number("film_ior", &E::filmIor),
      number("film_thickness", &E::filmMaxThickness),
      texture("base_color_texture", &Material::baseColorTexture, true),
      texture("metallic_roughness_texture", &Material::metallicRoughnessTexture, false),
      texture("normal_texture", &Material::normalTexture, false),
      texture("emission_texture", &Material::emissiveTexture, true),
  };
  return all;
}

}  // namespace

Material materialOf(const nb::dict& keywords, SceneBuilder& builder) {
  Material material;
  for (const auto [key, value] : keywords) {
    const std::string keyword = textOf(key, "Material(): a keyword");
    const auto found = std::ranges::find(fields(), keyword, &Field::keyword);
    if (found == fields().end()) {
      std::vector<std::string_view> known;
      for (const Field& field : fields()) known.push_back(field.keyword);
      throwInput("Material(): unknown keyword `{}`; {}", printableName(keyword),
                 didYouMean(keyword, known));
    }
    if (!value.is_none()) found->set(material, value, builder);
  }
  return material;
}

std::vector<std::string> materialKeywords() {
  std::vector<std::string> names;
  for (const Field& field : fields()) names.emplace_back(field.keyword);
  return names;
}

}  // namespace chromeball::python

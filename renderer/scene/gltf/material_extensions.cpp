// SPDX-License-Identifier: Apache-2.0
// MaterialReader: the extensions that add lobes and media to metallic-roughness materials.
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/material_reader.h"

namespace chromeball {

using tinygltf::Value;

float MaterialReader::Extension::number(const char* key, double fallback, double low,
                                        double high) const {
  return member(reader.file_, object, key, fallback, low, high, where);
}

Rgb MaterialReader::Extension::color(const char* key, const Rgb& fallback, double high) const {
  return vectorMember<3>(reader.file_, object, key, fallback, 0, high, where);
}

TextureSlot MaterialReader::Extension::texture(const char* key, TexelUse use) const {
  const Value& info = memberOf(object, key);
  if (!info.IsObject() || !memberOf(info, "index").IsInt()) return {};
  tinygltf::ExtensionMap extensions;
  if (const Value& nested = memberOf(info, "extensions"); nested.IsObject())
    for (const std::string& name : nested.Keys()) extensions[name] = memberOf(nested, name);
  return reader.slot(intMember(info, "index"), intMember(info, "texCoord", 0), extensions, use,
                     where + "." + key);
}

std::optional<MaterialReader::Extension> MaterialReader::find(
    const tinygltf::ExtensionMap& extensions, const char* name, const std::string& where) {
  const Value* object = findExtension(extensions, name);
  if (!object) return std::nullopt;
  return Extension{*this, *object, where};
}

namespace {

using Extension = MaterialReader::Extension;

void readVolume(const Extension& e, ExtendedMaterial& m) {
  // thicknessFactor only tells whether the mesh is a body; the geometry tells its thickness.
  m.thinWalled = e.number("thicknessFactor", 0, 0, INFINITY) == 0;
  if (!memberOf(e.object, "attenuationDistance").IsNumber()) return;
  // Solves exp(-attenuation distance) = color. A channel of 0 would give an infinite attenuation.
  const float distance = e.number("attenuationDistance", 0, 1e-6, 1e30);
  const Rgb color = e.color("attenuationColor", Rgb(1));
  m.attenuation = -glm::log(glm::max(color, Rgb(1e-6f))) / distance;
}

void readClearcoat(const Extension& e, ExtendedMaterial& m) {
  m.clearcoat = e.number("clearcoatFactor", 0);
  m.clearcoatTexture = e.texture("clearcoatTexture");
  m.clearcoatRoughness = e.number("clearcoatRoughnessFactor", 0);
  m.clearcoatRoughnessTexture = e.texture("clearcoatRoughnessTexture");
  m.clearcoatNormalTexture = e.texture("clearcoatNormalTexture");
  const Value& normal = memberOf(e.object, "clearcoatNormalTexture");
  if (normal.IsObject())
    m.clearcoatNormalScale =
        Extension{e.reader, normal, e.where + ".clearcoatNormalTexture"}.number("scale", 1, -1e6,
                                                                                1e6);
}

void readIridescence(const Extension& e, ExtendedMaterial& m) {
  m.iridescence = e.number("iridescenceFactor", 0);
  m.iridescenceTexture = e.texture("iridescenceTexture");
  m.filmIor = e.number("iridescenceIor", 1.3, 1, 1e3);
  m.filmMinThickness = e.number("iridescenceThicknessMinimum", 100, 0, 1e6);
  m.filmMaxThickness = e.number("iridescenceThicknessMaximum", 400, 0, 1e6);
  m.filmThicknessTexture = e.texture("iridescenceThicknessTexture");
}

}  // namespace

std::optional<ExtendedMaterial> MaterialReader::readExtensions(
    const tinygltf::ExtensionMap& extensions, const std::string& where) {
  const auto named = [&](const char* name) { return find(extensions, name, where); };
  ExtendedMaterial m;
  if (const auto e = named("KHR_materials_transmission")) {
    m.transmission = e->number("transmissionFactor", 0);
    m.transmissionTexture = e->texture("transmissionTexture");
  }
  if (const auto e = named("KHR_materials_volume")) readVolume(*e, m);
  if (const auto e = named("KHR_materials_dispersion"))
    m.dispersion = e->number("dispersion", 0, 0, 1e3);
  if (const auto e = named("KHR_materials_clearcoat")) readClearcoat(*e, m);
  if (const auto e = named("KHR_materials_sheen")) {
    m.sheenColor = e->color("sheenColorFactor", Rgb(0));
    m.sheenColorTexture = e->texture("sheenColorTexture", {.srgb = true});
    m.sheenRoughness = e->number("sheenRoughnessFactor", 0);
    m.sheenRoughnessTexture = e->texture("sheenRoughnessTexture");
  }
  if (const auto e = named("KHR_materials_anisotropy")) {
    m.anisotropy = e->number("anisotropyStrength", 0);
    m.anisotropyRotation = e->number("anisotropyRotation", 0, -1e6, 1e6);
    m.anisotropyTexture = e->texture("anisotropyTexture");
  }
  if (const auto e = named("KHR_materials_iridescence")) readIridescence(*e, m);
  if (m.transmission == 0 && m.clearcoat == 0 && isBlack(m.sheenColor) && m.anisotropy == 0 &&
      m.iridescence == 0)
    return std::nullopt;
  return m;
}

}  // namespace chromeball

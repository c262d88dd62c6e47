// SPDX-License-Identifier: Apache-2.0
// MaterialReader: the extensions that add lobes and media to metallic-roughness materials.
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/material_reader.h"

namespace chromeball {
namespace {

using tinygltf::Value;

// Solves exp(-attenuation distance) = color. A channel of 0 would give an infinite attenuation.
Rgb attenuationOf(const Rgb& color, float distance) {
  return -glm::log(glm::max(color, Rgb(1e-6f))) / distance;
}

}  // namespace

void MaterialReader::readTransmission(const tinygltf::ExtensionMap& extensions,
                                      const std::string& where, ExtendedMaterial& m) {
  if (const Value* e = findExtension(extensions, "KHR_materials_transmission")) {
    m.transmission = member(file_, *e, "transmissionFactor", 0, 0, 1, where);
    m.transmissionTexture =
        slot(memberOf(*e, "transmissionTexture"), false, where + ".transmissionTexture");
  }
  if (const Value* e = findExtension(extensions, "KHR_materials_volume")) {
    // thicknessFactor only tells whether the mesh is a body; the geometry tells its thickness.
    m.thinWalled = member(file_, *e, "thicknessFactor", 0, 0, INFINITY, where) == 0;
    const Value& distance = memberOf(*e, "attenuationDistance");
    if (distance.IsNumber())
      m.attenuation = attenuationOf(
          vectorMember<3>(file_, *e, "attenuationColor", vec3(1), 0, 1, where),
          number(file_, distance.GetNumberAsDouble(), 1e-6, 1e30, where + ".attenuationDistance"));
  }
  if (const Value* e = findExtension(extensions, "KHR_materials_dispersion"))
    m.dispersion = member(file_, *e, "dispersion", 0, 0, 1e3, where);
}

void MaterialReader::readClearcoat(const Value& e, const std::string& where, ExtendedMaterial& m) {
  m.clearcoat = member(file_, e, "clearcoatFactor", 0, 0, 1, where);
  m.clearcoatTexture = slot(memberOf(e, "clearcoatTexture"), false, where + ".clearcoatTexture");
  m.clearcoatRoughness = member(file_, e, "clearcoatRoughnessFactor", 0, 0, 1, where);
  m.clearcoatRoughnessTexture =
      slot(memberOf(e, "clearcoatRoughnessTexture"), false, where + ".clearcoatRoughnessTexture");
  const Value& normal = memberOf(e, "clearcoatNormalTexture");
  m.clearcoatNormalTexture = slot(normal, false, where + ".clearcoatNormalTexture");
  if (normal.IsObject())
    m.clearcoatNormalScale =
        member(file_, normal, "scale", 1, -1e6, 1e6, where + ".clearcoatNormalTexture");
}

void MaterialReader::readSheen(const Value& e, const std::string& where, ExtendedMaterial& m) {
  m.sheenColor = vectorMember<3>(file_, e, "sheenColorFactor", vec3(0), 0, 1, where);
  m.sheenColorTexture = slot(memberOf(e, "sheenColorTexture"), true, where + ".sheenColorTexture");
  m.sheenRoughness = member(file_, e, "sheenRoughnessFactor", 0, 0, 1, where);
  m.sheenRoughnessTexture =
      slot(memberOf(e, "sheenRoughnessTexture"), false, where + ".sheenRoughnessTexture");
}

void MaterialReader::readAnisotropy(const Value& e, const std::string& where, ExtendedMaterial& m) {
  m.anisotropy = member(file_, e, "anisotropyStrength", 0, 0, 1, where);
  m.anisotropyRotation = member(file_, e, "anisotropyRotation", 0, -1e6, 1e6, where);
  m.anisotropyTexture = slot(memberOf(e, "anisotropyTexture"), false, where + ".anisotropyTexture");
}

void MaterialReader::readIridescence(const Value& e, const std::string& where,
                                     ExtendedMaterial& m) {
  m.iridescence = member(file_, e, "iridescenceFactor", 0, 0, 1, where);
  m.iridescenceTexture =
      slot(memberOf(e, "iridescenceTexture"), false, where + ".iridescenceTexture");
  m.filmIor = member(file_, e, "iridescenceIor", 1.3, 1, 1e3, where);
  m.filmMinThickness = member(file_, e, "iridescenceThicknessMinimum", 100, 0, 1e6, where);
  m.filmMaxThickness = member(file_, e, "iridescenceThicknessMaximum", 400, 0, 1e6, where);
  m.filmThicknessTexture = slot(memberOf(e, "iridescenceThicknessTexture"), false,
                                where + ".iridescenceThicknessTexture");
}

std::optional<ExtendedMaterial> MaterialReader::readExtensions(
    const tinygltf::ExtensionMap& extensions, const std::string& where) {
  ExtendedMaterial m;
  readTransmission(extensions, where, m);
  if (const Value* e = findExtension(extensions, "KHR_materials_clearcoat"))
    readClearcoat(*e, where, m);
  if (const Value* e = findExtension(extensions, "KHR_materials_sheen")) readSheen(*e, where, m);
  if (const Value* e = findExtension(extensions, "KHR_materials_anisotropy"))
    readAnisotropy(*e, where, m);
  if (const Value* e = findExtension(extensions, "KHR_materials_iridescence"))
    readIridescence(*e, where, m);
  if (m.transmission == 0 && m.clearcoat == 0 && isBlack(m.sheenColor) && m.anisotropy == 0 &&
      m.iridescence == 0)
    return std::nullopt;
  return m;
}

}  // namespace chromeball

// The material extensions that add lobes and media to metallic-roughness.
#include "scene/gltf_material.h"
#include "scene/gltf_value.h"

namespace chromeball {
namespace {

using tinygltf::Value;

// exp(-attenuation distance) = color. Zero in a channel would be an infinite attenuation.
Rgb attenuationOf(const Rgb& color, float distance) {
  return -glm::log(glm::max(color, Rgb(1e-6f))) / distance;
}

}  // namespace

void MaterialReader::readTransmission(const tinygltf::ExtensionMap& extensions,
                                      const std::string& where, ExtendedMaterial& m) {
  if (const Value* e = findExtension(extensions, "KHR_materials_transmission")) {
    m.transmission = member(file_, *e, "transmissionFactor", 0, 0, 1, where);
    m.transmissionTexture =
        slot(e->Get("transmissionTexture"), false, where + ".transmissionTexture");
  }
  if (const Value* e = findExtension(extensions, "KHR_materials_volume")) {
    // How thick the body is, its own geometry says; only whether it is one, this factor.
    m.thinWalled = member(file_, *e, "thicknessFactor", 0, 0, INFINITY, where) == 0;
    const Value& distance = e->Get("attenuationDistance");
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
  m.clearcoatTexture = slot(e.Get("clearcoatTexture"), false, where + ".clearcoatTexture");
  m.clearcoatRoughness = member(file_, e, "clearcoatRoughnessFactor", 0, 0, 1, where);
  m.clearcoatRoughnessTexture =
      slot(e.Get("clearcoatRoughnessTexture"), false, where + ".clearcoatRoughnessTexture");
  const Value& normal = e.Get("clearcoatNormalTexture");
  m.clearcoatNormalTexture = slot(normal, false, where + ".clearcoatNormalTexture");
  if (normal.IsObject())
    m.clearcoatNormalScale =
        member(file_, normal, "scale", 1, -1e6, 1e6, where + ".clearcoatNormalTexture");
}

std::optional<ExtendedMaterial> MaterialReader::readExtensions(
    const tinygltf::ExtensionMap& extensions, const std::string& where) {
  ExtendedMaterial m;
  readTransmission(extensions, where, m);
  if (const Value* e = findExtension(extensions, "KHR_materials_clearcoat"))
    readClearcoat(*e, where, m);
  if (m.transmission == 0 && m.clearcoat == 0) return std::nullopt;
  return m;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Members whose types differ from the specification's: each is refused by its path.
#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "json_file.h"
#include "scene/gltf/gltf_json.h"

namespace chromeball::gltf_member_types_test {
namespace {

using nlohmann::json;

// Valid types: members that are numbers have a fraction, and whole numbers have none.
const json kEveryMember = parseJson(R"({
  "accessors": [{"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 1, "name": "a",
                 "normalized": true, "type": "VEC3",
                 "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 0,
                                                    "componentType": 5121},
                            "values": {"bufferView": 0, "byteOffset": 0}}}],
  "animations": [{"name": "a", "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
                  "samplers": [{"input": 0, "output": 0, "interpolation": "STEP"}]}],
  "asset": {"version": "2.0", "minVersion": "2.0"},
  "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 1, "byteStride": 4, "target": 34962,
                   "name": "v",
                   "extensions": {
                     "EXT_meshopt_compression": {"buffer": 0, "byteLength": 1, "byteOffset": 0,
                       "byteStride": 4, "count": 1, "filter": "NONE", "mode": "INDICES"},
                     "KHR_meshopt_compression": {"buffer": 0, "byteLength": 1, "byteOffset": 0,
                       "byteStride": 4, "count": 1, "filter": "NONE", "mode": "INDICES"}}}],
  "buffers": [{"byteLength": 1, "name": "b", "uri": "b.bin"}],
  "cameras": [{"name": "c", "type": "perspective",
               "perspective": {"yfov": 0.5, "znear": 0.5, "zfar": 1.5, "aspectRatio": 1.5},
               "orthographic": {"xmag": 0.5, "ymag": 0.5, "znear": 0.5, "zfar": 1.5}}],
  "extensionsRequired": ["KHR_lights_punctual"],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {
    "EXT_lights_image_based": {"lights": [{"intensity": 0.5, "rotation": [0.5],
      "irradianceCoefficients": [[0.5]], "specularImages": [[0]]}]},
    "KHR_lights_punctual": {"lights": [{"type": "spot", "name": "l", "color": [0.5],
      "intensity": 0.5, "range": 0.5, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]},
    "KHR_materials_variants": {"variants": [{"name": "v"}]}},
  "images": [{"bufferView": 0, "mimeType": "image/png", "name": "i", "uri": "i.png"}],
  "materials": [{"name": "m", "alphaCutoff": 0.5, "alphaMode": "MASK", "doubleSided": true,
    "emissiveFactor": [0.5], "emissiveTexture": {"index": 0, "texCoord": 0},
    "normalTexture": {"index": 0, "texCoord": 0, "scale": 0.5},
    "occlusionTexture": {"index": 0, "texCoord": 0, "strength": 0.5},
    "pbrMetallicRoughness": {"baseColorFactor": [0.5], "metallicFactor": 0.5,
      "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0},
      "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0.5], "rotation": 0.5, "scale": [0.5], "texCoord": 0}}}},
    "extensions": {
      "KHR_materials_anisotropy": {"anisotropyRotation": 0.5, "anisotropyStrength": 0.5,
        "anisotropyTexture": {"index": 0}},
      "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.5,
        "clearcoatTexture": {"index": 0}, "clearcoatRoughnessTexture": {"index": 0},
        "clearcoatNormalTexture": {"index": 0, "scale": 0.5}},
      "KHR_materials_dispersion": {"dispersion": 0.5},
      "KHR_materials_emissive_strength": {"emissiveStrength": 0.5},
      "KHR_materials_ior": {"ior": 1.5},
      "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 1.5,
        "iridescenceThicknessMinimum": 0.5, "iridescenceThicknessMaximum": 0.5,
        "iridescenceTexture": {"index": 0}, "iridescenceThicknessTexture": {"index": 0}},
      "KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5], "specularFactor": [0.5],
        "glossinessFactor": 0.5, "diffuseTexture": {"index": 0},
        "specularGlossinessTexture": {"index": 0}},
      "KHR_materials_sheen": {"sheenColorFactor": [0.5], "sheenRoughnessFactor": 0.5,
        "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 0}},
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [0.5],
        "specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}},
      "KHR_materials_transmission": {"transmissionFactor": 0.5,
        "transmissionTexture": {"index": 0}},
      "KHR_materials_unlit": {},
      "KHR_materials_volume": {"attenuationColor": [0.5], "attenuationDistance": 0.5,
        "thicknessFactor": 0.5}}}],
  "meshes": [{"name": "m", "weights": [0.5], "primitives": [{"attributes": {"POSITION": 0},
    "indices": 0, "material": 0, "mode": 4, "targets": [{"POSITION": 0}],
    "extensions": {
      "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}},
      "KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}]}}}]}],
  "nodes": [{"camera": 0, "children": [1], "matrix": [0.5], "mesh": 0, "name": "n",
    "rotation": [0.5], "scale": [0.5], "skin": 0, "translation": [0.5], "weights": [0.5],
    "extensions": {
      "EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 0}},
      "KHR_lights_punctual": {"light": 0},
      "KHR_node_visibility": {"visible": true}}}],
  "samplers": [{"magFilter": 9728, "minFilter": 9728, "name": "s", "wrapS": 10497, "wrapT": 10497}],
  "scene": 0,
  "scenes": [{"name": "s", "nodes": [0], "extensions": {"EXT_lights_image_based": {"light": 0}}}],
  "skins": [{"inverseBindMatrices": 0, "joints": [0], "name": "s", "skeleton": 0}],
  "textures": [{"name": "t", "sampler": 0, "source": 0,
                "extensions": {"EXT_texture_webp": {"source": 0}}}]
})");

std::string complaintOf(json root) {
  try {
    checkMemberTypes(root);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

// Values of all types but the type of `value`.
std::vector<json> valuesUnlike(const json& value) {
  std::vector<json> others;
  for (const char* text : {"null", "true", "\"1\"", "[]", "{}", "0.5", "-1", "4294967296e9"}) {
    const json other = parseJson(text);
    if (other.is_number() ? !value.is_number_float() : other.type() != value.type())
      others.push_back(other);
  }
  return others;
}

// Puts each value unlike it into the place of each value of `part`, a part of `root`.
void expectPathsOfWrongTypes(json& root, json& part, const std::string& path) {
  if (!part.is_structured()) return;
  for (const auto& [key, value] : part.items()) {
    const std::string at = part.is_array() ? path + "[" + key + "]"
                           : path.empty()  ? key
                                           : path + "." + key;
    const json valid = value;
    for (const json& wrong : valuesUnlike(valid)) {
      value = wrong;
      EXPECT_TRUE(complaintOf(root).starts_with(at + ": must be "))
          << at << ' ' << wrong << ": " << complaintOf(root);
    }
    value = valid;
    expectPathsOfWrongTypes(root, value, at);
  }
}

TEST(GltfMemberTypes, EveryMemberIsNamedByItsPath) {
  json root = kEveryMember;
  ASSERT_EQ(complaintOf(root), "");
  expectPathsOfWrongTypes(root, root, "");
}

TEST(GltfMemberTypes, MessagesNameTheTypeAndTheValue) {
  json root = kEveryMember;
  const auto complaint = [&](const char* pointer, const json& value) {
    json changed = root;
    changed[json::json_pointer(pointer)] = value;
    return complaintOf(changed);
  };
  EXPECT_EQ(complaint("/nodes/0/mesh", -1),
            "nodes[0].mesh: must be a whole number from 0 to 2147483647, not -1");
  EXPECT_EQ(complaint("/nodes/0/children/0", 4294967296u),
            "nodes[0].children[0]: must be a whole number from 0 to 2147483647, not 4294967296");
  EXPECT_EQ(complaint("/extensionsRequired", "KHR_x"),
            "extensionsRequired: must be an array, not a string");
  EXPECT_EQ(complaint("/meshes/0/primitives/0/attributes/POSITION", "0"),
            "meshes[0].primitives[0].attributes.POSITION: must be a whole number from 0 to "
            "2147483647, not a string");
  EXPECT_EQ(complaint("/nodes/0/extensions/KHR_node_visibility/visible", nullptr),
            "nodes[0].extensions.KHR_node_visibility.visible: must be true or false, not null");
}

// Buffers may exceed 4 GB, and other programs may add anything.
TEST(GltfMemberTypes, WhatTheSpecificationAllowsPasses) {
  json root = kEveryMember;
  root["buffers"][0]["byteLength"] = 5000000000u;
  root["bufferViews"][0]["byteOffset"] = 5000000000u;
  root["nodes"][0]["extras"] = "x";
  root["nodes"][0]["own"] = nullptr;
  root["nodes"][0][""] = 1;
  root["extensions"]["EXT_other"] = 1;
  EXPECT_EQ(complaintOf(root), "");
}

void writeWithFractions(json& value) {
  if (value.is_number_unsigned()) value = value.get<double>();
  if (value.is_structured())
    for (const auto& [key, part] : value.items()) writeWithFractions(part);
}

// glTF 2.0, "JSON Encoding".
TEST(GltfMemberTypes, WholeNumbersMayHaveAFractionOfZero) {
  json root = kEveryMember;
  writeWithFractions(root);
  checkMemberTypes(root);
  EXPECT_EQ(root["nodes"], kEveryMember["nodes"]);
  EXPECT_TRUE(root["nodes"][0]["mesh"].is_number_unsigned());

  GltfWriter plain, fractions;
  for (GltfWriter* w : {&plain, &fractions})
    addTriangle(*w, {{"material", w->add("materials", {{"doubleSided", true}})}});
  writeWithFractions(fractions.root);
  const Scene scene = fractions.load();
  EXPECT_EQ(scene.triangleCount(), 1u);
  EXPECT_TRUE(scene.materials.at(size_t(scene.instances.at(0).material)).doubleSided);
  EXPECT_EQ(scene.meshes.at(0), plain.load().meshes.at(0));
}

// Each would otherwise be read as a valid file: 2^32 as 0, -1 and strings as the default.
TEST(GltfMemberTypes, FilesAreRefused) {
  const std::pair<const char*, const char*> members[] = {
      {"/nodes/0/mesh", "4294967296"},
      {"/nodes/0/translation", "\"x\""},
      {"/bufferViews/0/byteOffset", "18446744073709551616"},
      {"/bufferViews/0/byteOffset", "-4"},
      {"/meshes/0/primitives/0/material", "-1"},
      {"/meshes/0/primitives/0/mode", "\"4\""},
      {"/extensionsRequired", "\"KHR_unknown\""},
      {"/nodes/0/extensions/KHR_lights_punctual/light", "\"0\""},
      {"/materials", "[{\"extensions\": {\"KHR_materials_unlit\": false}}]"}};
  for (const auto& [pointer, value] : members) {
    GltfWriter w;
    addTriangle(w);
    ASSERT_EQ(w.errorMessage(), "");
    w.root[json::json_pointer(pointer)] = parseJson(value);
    EXPECT_NE(w.errorMessage().find(": must be "), std::string::npos)
        << pointer << ": " << w.errorMessage();
  }
}

}  // namespace
}  // namespace chromeball::gltf_member_types_test

// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/member_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <stdexcept>
#include <string_view>

#include "base/json.h"
#include "base/json_text.h"
#include "base/printable.h"

namespace chromeball {
namespace {

using nlohmann::json;

struct MemberType {
  std::string_view name, type;
};
constexpr size_t kMostMembers = 17;
struct ObjectType {
  std::string_view kind;
  MemberType members[kMostMembers];
};

// The members of each kind of object; of an extension, in all places that it may have. Types are
// these kinds, those of isScalar(), `T[]`, an array of T, and `T{}`, an object with any members of
// type T.
constexpr ObjectType kObjects[] = {
    {"File",
     {{"accessors", "Accessor[]"},
      {"animations", "Animation[]"},
      {"asset", "Asset"},
      {"bufferViews", "BufferView[]"},
      {"buffers", "Buffer[]"},
      {"cameras", "Camera[]"},
      {"extensionsRequired", "string[]"},
      {"extensionsUsed", "string[]"},
      {"images", "Image[]"},
      {"materials", "Material[]"},
      {"meshes", "Mesh[]"},
      {"nodes", "Node[]"},
      {"samplers", "Sampler[]"},
      {"scene", "integer"},
      {"scenes", "Scene[]"},
      {"skins", "Skin[]"},
      {"textures", "Texture[]"}}},
    {"Asset", {{"minVersion", "string"}, {"version", "string"}}},

    {"Buffer", {{"byteLength", "size"}, {"name", "string"}, {"uri", "string"}}},
    {"BufferView",
     {{"buffer", "integer"},
      {"byteLength", "size"},
      {"byteOffset", "size"},
      {"byteStride", "size"},
      {"name", "string"},
      {"target", "integer"}}},
    {"Accessor",
     {{"bufferView", "integer"},
      {"byteOffset", "size"},
      {"componentType", "integer"},
      {"count", "size"},
      {"name", "string"},
      {"normalized", "boolean"},
      {"sparse", "Sparse"},
      {"type", "string"}}},
    {"Sparse", {{"count", "integer"}, {"indices", "SparseView"}, {"values", "SparseView"}}},
    {"SparseView",
     {{"bufferView", "integer"}, {"byteOffset", "integer"}, {"componentType", "integer"}}},

    {"Scene", {{"name", "string"}, {"nodes", "integer[]"}}},
    {"Node",
     {{"camera", "integer"},
      {"children", "integer[]"},
      {"matrix", "number[]"},
      {"mesh", "integer"},
      {"name", "string"},
      {"rotation", "number[]"},
      {"scale", "number[]"},
      {"skin", "integer"},
      {"translation", "number[]"},
      {"weights", "number[]"}}},
    {"Mesh", {{"name", "string"}, {"primitives", "Primitive[]"}, {"weights", "number[]"}}},
    {"Primitive",
     {{"attributes", "integer{}"},
      {"indices", "integer"},
      {"material", "integer"},
      {"mode", "integer"},
      {"targets", "integer{}[]"}}},
    {"Skin",
     {{"inverseBindMatrices", "integer"},
      {"joints", "integer[]"},
      {"name", "string"},
      {"skeleton", "integer"}}},
    {"Camera",
     {{"name", "string"}, {"orthographic", "Lens"}, {"perspective", "Lens"}, {"type", "string"}}},
    {"Lens",
     {{"aspectRatio", "number"},
      {"xmag", "number"},
      {"yfov", "number"},
      {"ymag", "number"},
      {"zfar", "number"},
      {"znear", "number"}}},
    {"Animation", {{"channels", "Channel[]"}, {"name", "string"}, {"samplers", "Track[]"}}},
    {"Channel", {{"sampler", "integer"}, {"target", "Target"}}},
    {"Target", {{"node", "integer"}, {"path", "string"}}},
    {"Track", {{"input", "integer"}, {"interpolation", "string"}, {"output", "integer"}}},

    {"Image",
     {{"bufferView", "integer"}, {"mimeType", "string"}, {"name", "string"}, {"uri", "string"}}},
    {"Sampler",
     {{"magFilter", "integer"},
      {"minFilter", "integer"},
      {"name", "string"},
      {"wrapS", "integer"},
      {"wrapT", "integer"}}},
    {"Texture", {{"name", "string"}, {"sampler", "integer"}, {"source", "integer"}}},
    {"TextureInfo",
     {{"index", "integer"}, {"scale", "number"}, {"strength", "number"}, {"texCoord", "integer"}}},
    {"Material",
     {{"alphaCutoff", "number"},
      {"alphaMode", "string"},
      {"doubleSided", "boolean"},
      {"emissiveFactor", "number[]"},
      {"emissiveTexture", "TextureInfo"},
      {"name", "string"},
      {"normalTexture", "TextureInfo"},
      {"occlusionTexture", "TextureInfo"},
      {"pbrMetallicRoughness", "MetallicRoughness"}}},
    {"MetallicRoughness",
     {{"baseColorFactor", "number[]"},
      {"baseColorTexture", "TextureInfo"},
      {"metallicFactor", "number"},
      {"metallicRoughnessTexture", "TextureInfo"},
      {"roughnessFactor", "number"}}},

    {"EXT_lights_image_based", {{"light", "integer"}, {"lights", "ImageLight[]"}}},
    {"ImageLight",
     {{"intensity", "number"},
      {"irradianceCoefficients", "number[][]"},
      {"rotation", "number[]"},
      {"specularImages", "integer[][]"}}},
    {"EXT_mesh_gpu_instancing", {{"attributes", "integer{}"}}},
    {"EXT_meshopt_compression",
     {{"buffer", "integer"},
      {"byteLength", "size"},
      {"byteOffset", "size"},
      {"byteStride", "size"},
      {"count", "size"},
      {"filter", "string"},
      {"mode", "string"}}},
    {"EXT_texture_webp", {{"source", "integer"}}},
    {"KHR_draco_mesh_compression", {{"attributes", "integer{}"}, {"bufferView", "integer"}}},
    {"KHR_lights_punctual", {{"light", "integer"}, {"lights", "Light[]"}}},
    {"Light",
     {{"color", "number[]"},
      {"intensity", "number"},
      {"name", "string"},
      {"range", "number"},
      {"spot", "Spot"},
      {"type", "string"}}},
    {"Spot", {{"innerConeAngle", "number"}, {"outerConeAngle", "number"}}},
    {"KHR_materials_anisotropy",
     {{"anisotropyRotation", "number"},
      {"anisotropyStrength", "number"},
      {"anisotropyTexture", "TextureInfo"}}},
    {"KHR_materials_clearcoat",
     {{"clearcoatFactor", "number"},
      {"clearcoatNormalTexture", "TextureInfo"},
      {"clearcoatRoughnessFactor", "number"},
      {"clearcoatRoughnessTexture", "TextureInfo"},
      {"clearcoatTexture", "TextureInfo"}}},
    {"KHR_materials_dispersion", {{"dispersion", "number"}}},
    {"KHR_materials_emissive_strength", {{"emissiveStrength", "number"}}},
    {"KHR_materials_ior", {{"ior", "number"}}},
    {"KHR_materials_iridescence",
     {{"iridescenceFactor", "number"},
      {"iridescenceIor", "number"},
      {"iridescenceTexture", "TextureInfo"},
      {"iridescenceThicknessMaximum", "number"},
      {"iridescenceThicknessMinimum", "number"},
      {"iridescenceThicknessTexture", "TextureInfo"}}},
    {"KHR_materials_pbrSpecularGlossiness",
     {{"diffuseFactor", "number[]"},
      {"diffuseTexture", "TextureInfo"},
      {"glossinessFactor", "number"},
      {"specularFactor", "number[]"},
      {"specularGlossinessTexture", "TextureInfo"}}},
    {"KHR_materials_sheen",
     {{"sheenColorFactor", "number[]"},
      {"sheenColorTexture", "TextureInfo"},
      {"sheenRoughnessFactor", "number"},
      {"sheenRoughnessTexture", "TextureInfo"}}},
    {"KHR_materials_specular",
     {{"specularColorFactor", "number[]"},
      {"specularColorTexture", "TextureInfo"},
      {"specularFactor", "number"},
      {"specularTexture", "TextureInfo"}}},
    {"KHR_materials_transmission",
     {{"transmissionFactor", "number"}, {"transmissionTexture", "TextureInfo"}}},
    {"KHR_materials_unlit", {}},
    {"KHR_materials_variants", {{"mappings", "Mapping[]"}, {"variants", "Variant[]"}}},
    {"Mapping", {{"material", "integer"}, {"variants", "integer[]"}}},
    {"Variant", {{"name", "string"}}},
    {"KHR_materials_volume",
     {{"attenuationColor", "number[]"},
      {"attenuationDistance", "number"},
      {"thicknessFactor", "number"}}},
    {"KHR_node_visibility", {{"visible", "boolean"}}},
    {"KHR_texture_transform",
     {{"offset", "number[]"},
      {"rotation", "number"},
      {"scale", "number[]"},
      {"texCoord", "integer"}}},
};

// Null if there is none.
const ObjectType* findObjectType(std::string_view kind) {
  const auto found = std::ranges::find(kObjects, kind, &ObjectType::kind);
  return found == std::end(kObjects) ? nullptr : found;
}
const MemberType* findMemberType(const ObjectType& object, std::string_view name) {
  const auto found = std::ranges::find(object.members, name, &MemberType::name);
  return found == std::end(object.members) || found->type.empty() ? nullptr : found;
}

// Where a value is in the file: a member or an element of its parent.
struct JsonPlace {
  const JsonPlace* parent = nullptr;  // null: the file itself
  std::string_view member = {};       // empty: an element of an array
  size_t element = 0;

  std::string text() const {
    if (!parent) return "";
    const std::string before = parent->text();
    if (member.empty()) return fmt::format("{}[{}]", before, element);
    return fmt::format("{}{}{}", before, before.empty() ? "" : ".", printableName(member));
  }
};

// tinygltf keeps an `integer` as int and a `size` as size_t; doubles are whole up to 2^53.
constexpr uint64_t kMaxInteger = INT_MAX, kMaxSize = uint64_t(1) << 53;

bool isWhole(const json& value, uint64_t max) {
  return value.is_number_unsigned() && value.get<uint64_t>() <= max;
}

bool isScalar(std::string_view type, const json& value) {
  if (type == "integer") return isWhole(value, kMaxInteger);
  if (type == "size") return isWhole(value, kMaxSize);
  if (type == "number") return value.is_number();
  if (type == "boolean") return value.is_boolean();
  return value.is_string();
}

std::string describeType(std::string_view type) {
  if (type.ends_with("[]")) return "an array";
  if (type == "integer") return fmt::format("a whole number from 0 to {}", kMaxInteger);
  if (type == "size") return fmt::format("a whole number from 0 to {}", kMaxSize);
  if (type == "number") return "a number";
  if (type == "boolean") return "true or false";
  if (type == "string") return "a string";
  return "an object";
}

std::string describeValue(const json& value) {
  if (value.is_string()) return "a string";
  if (value.is_array()) return "an array";
  if (value.is_object()) return "an object";
  return jsonText(value);
}

void require(bool matches, const json& value, std::string_view type, const JsonPlace& place) {
  if (!matches)
    throw std::runtime_error(fmt::format("{}: must be {}, not {}", place.text(), describeType(type),
                                         describeValue(value)));
}

void checkObject(const json& value, const ObjectType& object, const JsonPlace& place);

void checkType(const json& value, std::string_view type, const JsonPlace& place) {
  if (type.ends_with("[]")) {
    require(value.is_array(), value, type, place);
    type.remove_suffix(2);
    for (size_t i = 0; i < value.size(); ++i) checkType(value[i], type, {&place, {}, i});
  } else if (type.ends_with("{}")) {
    require(value.is_object(), value, type, place);
    type.remove_suffix(2);
    for (const auto& [name, member] : value.items()) checkType(member, type, {&place, name});
  } else if (const ObjectType* object = findObjectType(type)) {
    checkObject(value, *object, place);
  } else {
    require(isScalar(type, value), value, type, place);
  }
}

void checkExtensionTypes(const json& extensions, const JsonPlace& place) {
  require(extensions.is_object(), extensions, "object", place);
  const auto kindOf = [](std::string_view name) {
    return name == "KHR_meshopt_compression" ? "EXT_meshopt_compression"
                                             : name;  // the same members
  };
  for (const auto& [name, extension] : extensions.items())
    if (const ObjectType* object = findObjectType(kindOf(name)))
      checkObject(extension, *object, {&place, name});
}

void checkObject(const json& value, const ObjectType& object, const JsonPlace& place) {
  require(value.is_object(), value, object.kind, place);
  for (const auto& [name, element] : value.items())
    if (name == "extensions")
      checkExtensionTypes(element, {&place, name});
    else if (const MemberType* member = findMemberType(object, name))
      checkType(element, member->type, {&place, name});
}

}  // namespace

void checkMemberTypes(const json& root) { checkType(root, "File", {}); }

}  // namespace chromeball

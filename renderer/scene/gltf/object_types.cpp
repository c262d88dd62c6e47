// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_json.h"

#include <algorithm>
#include <iterator>

namespace chromeball {
namespace {

constexpr std::string_view kMeshopt =
    "buffer:integer byteLength:size byteOffset:size byteStride:size count:size filter:string "
    "mode:string";

// An extension has the members of all places where it may occur.
constexpr ObjectType kObjects[] = {
    {"File",
     "accessors:Accessor[] animations:Animation[] asset:Asset bufferViews:BufferView[] "
     "buffers:Buffer[] cameras:Camera[] extensionsRequired:string[] extensionsUsed:string[] "
     "images:Image[] materials:Material[] meshes:Mesh[] nodes:Node[] samplers:Sampler[] "
     "scene:integer scenes:Scene[] skins:Skin[] textures:Texture[]"},
    {"Asset", "minVersion:string version:string"},

    {"Buffer", "byteLength:size name:string uri:string"},
    {"BufferView",
     "buffer:integer byteLength:size byteOffset:size byteStride:size name:string target:integer"},
    {"Accessor",
     "bufferView:integer byteOffset:size componentType:integer count:size name:string "
     "normalized:boolean sparse:Sparse type:string"},
    {"Sparse", "count:integer indices:SparseView values:SparseView"},
    {"SparseView", "bufferView:integer byteOffset:integer componentType:integer"},

    {"Scene", "name:string nodes:integer[]"},
    {"Node",
     "camera:integer children:integer[] matrix:number[] mesh:integer name:string rotation:number[] "
     "scale:number[] skin:integer translation:number[] weights:number[]"},
    {"Mesh", "name:string primitives:Primitive[] weights:number[]"},
    {"Primitive",
     "attributes:integer{} indices:integer material:integer mode:integer targets:integer{}[]"},
    {"Skin", "inverseBindMatrices:integer joints:integer[] name:string skeleton:integer"},
    {"Camera", "name:string orthographic:Lens perspective:Lens type:string"},
    {"Lens", "aspectRatio:number xmag:number yfov:number ymag:number zfar:number znear:number"},
    {"Animation", "channels:Channel[] name:string samplers:Track[]"},
    {"Channel", "sampler:integer target:Target"},
    {"Target", "node:integer path:string"},
    {"Track", "input:integer interpolation:string output:integer"},

    {"Image", "bufferView:integer mimeType:string name:string uri:string"},
    {"Sampler", "magFilter:integer minFilter:integer name:string wrapS:integer wrapT:integer"},
    {"Texture", "name:string sampler:integer source:integer"},
    {"TextureInfo", "index:integer scale:number strength:number texCoord:integer"},
    {"Material",
     "alphaCutoff:number alphaMode:string doubleSided:boolean emissiveFactor:number[] "
     "emissiveTexture:TextureInfo name:string normalTexture:TextureInfo "
     "occlusionTexture:TextureInfo pbrMetallicRoughness:MetallicRoughness"},
    {"MetallicRoughness",
     "baseColorFactor:number[] baseColorTexture:TextureInfo metallicFactor:number "
     "metallicRoughnessTexture:TextureInfo roughnessFactor:number"},

    {"EXT_lights_image_based", "light:integer lights:ImageLight[]"},
    {"ImageLight",
     "intensity:number irradianceCoefficients:number[][] rotation:number[] "
     "specularImages:integer[][]"},
    {"EXT_mesh_gpu_instancing", "attributes:integer{}"},
    {"EXT_meshopt_compression", kMeshopt},
    {"EXT_texture_webp", "source:integer"},
    {"KHR_draco_mesh_compression", "attributes:integer{} bufferView:integer"},
    {"KHR_lights_punctual", "light:integer lights:Light[]"},
    {"Light", "color:number[] intensity:number name:string range:number spot:Spot type:string"},
    {"Spot", "innerConeAngle:number outerConeAngle:number"},
    {"KHR_materials_anisotropy",
     "anisotropyRotation:number anisotropyStrength:number anisotropyTexture:TextureInfo"},
    {"KHR_materials_clearcoat",
     "clearcoatFactor:number clearcoatNormalTexture:TextureInfo clearcoatRoughnessFactor:number "
     "clearcoatRoughnessTexture:TextureInfo clearcoatTexture:TextureInfo"},
    {"KHR_materials_dispersion", "dispersion:number"},
    {"KHR_materials_emissive_strength", "emissiveStrength:number"},
    {"KHR_materials_ior", "ior:number"},
    {"KHR_materials_iridescence",
     "iridescenceFactor:number iridescenceIor:number iridescenceTexture:TextureInfo "
     "iridescenceThicknessMaximum:number iridescenceThicknessMinimum:number "
     "iridescenceThicknessTexture:TextureInfo"},
    {"KHR_materials_pbrSpecularGlossiness",
     "diffuseFactor:number[] diffuseTexture:TextureInfo glossinessFactor:number "
     "specularFactor:number[] specularGlossinessTexture:TextureInfo"},
    {"KHR_materials_sheen",
     "sheenColorFactor:number[] sheenColorTexture:TextureInfo sheenRoughnessFactor:number "
     "sheenRoughnessTexture:TextureInfo"},
    {"KHR_materials_specular",
     "specularColorFactor:number[] specularColorTexture:TextureInfo specularFactor:number "
     "specularTexture:TextureInfo"},
    {"KHR_materials_transmission", "transmissionFactor:number transmissionTexture:TextureInfo"},
    {"KHR_materials_unlit", ""},
    {"KHR_materials_variants", "mappings:Mapping[] variants:Variant[]"},
    {"Mapping", "material:integer variants:integer[]"},
    {"Variant", "name:string"},
    {"KHR_materials_volume",
     "attenuationColor:number[] attenuationDistance:number thicknessFactor:number"},
    {"KHR_meshopt_compression", kMeshopt},
    {"KHR_node_visibility", "visible:boolean"},
    {"KHR_texture_transform", "offset:number[] rotation:number scale:number[] texCoord:integer"},
};

}  // namespace

const ObjectType* findObjectType(std::string_view kind) {
  const auto found = std::ranges::find(kObjects, kind, &ObjectType::kind);
  return found == std::end(kObjects) ? nullptr : found;
}

std::string_view memberTypeOf(const ObjectType& object, std::string_view name) {
  for (std::string_view rest = object.members; !rest.empty();) {
    const std::string_view member = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(member.size() + 1, rest.size()));
    const size_t colon = member.find(':');
    if (member.substr(0, colon) == name) return member.substr(colon + 1);
  }
  return {};
}

}  // namespace chromeball
